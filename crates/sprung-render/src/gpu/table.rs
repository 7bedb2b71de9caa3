//! Tables: long lists kept in textures, because WebGL2 lets vertex shaders read nothing else.

use wgpu::{
    Device, Extent3d, Queue, TexelCopyBufferLayout, TexelCopyTextureInfo, Texture, TextureDescriptor,
    TextureDimension, TextureFormat, TextureUsages, TextureView,
};

/// Entries in a row; `cell` in common.wgsl knows it too. Every device allows textures of this width.
pub const WIDTH: usize = 2048;

/// A list of texels in rows of [`WIDTH`].
pub struct Table {
    label: &'static str,
    format: TextureFormat,
    texture: Texture,
    /// What a bind group takes.
    pub view: TextureView,
    rows: u32,
}

impl Table {
    /// An empty table, with room for one row.
    pub fn new(device: &Device, label: &'static str, format: TextureFormat) -> Self {
        let texture = make(device, label, format, 1);
        let view = texture.create_view(&Default::default());
        Self { label, format, texture, view, rows: 1 }
    }

    /// How many entries a table can have on this device.
    pub fn most(device: &Device) -> usize {
        WIDTH * device.limits().max_texture_dimension_2d as usize
    }

    /// Makes room for `len` entries, forgetting the old ones if that takes a new texture; true if it does. More than
    /// [`Table::most`] do not fit, and are left out.
    pub fn make_room(&mut self, device: &Device, len: usize) -> bool {
        let len = len.min(Self::most(device));
        let rows = len.div_ceil(WIDTH).max(1) as u32;
        if rows == self.rows {
            return false;
        }
        self.texture = make(device, self.label, self.format, rows);
        self.view = self.texture.create_view(&Default::default());
        self.rows = rows;
        true
    }

    /// Overwrites the first entries; those beyond the table's room are left out.
    pub fn write<T: bytemuck::Pod>(&self, queue: &Queue, entries: &[T]) {
        let entries = &entries[..entries.len().min(WIDTH * self.rows as usize)];
        let (full, rest) = entries.split_at(entries.len() / WIDTH * WIDTH);
        let rows = (full.len() / WIDTH) as u32;
        self.write_rows(queue, 0, WIDTH as u32, rows, bytemuck::cast_slice(full));
        self.write_rows(queue, rows, rest.len() as u32, 1, bytemuck::cast_slice(rest));
    }

    fn write_rows(&self, queue: &Queue, first: u32, width: u32, rows: u32, bytes: &[u8]) {
        if bytes.is_empty() {
            return;
        }
        let mut place: TexelCopyTextureInfo<'_> = self.texture.as_image_copy();
        place.origin.y = first;
        let layout = TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some((bytes.len() / rows as usize) as u32),
            rows_per_image: None,
        };
        queue.write_texture(place, bytes, layout, Extent3d { width, height: rows, depth_or_array_layers: 1 });
    }
}

fn make(device: &Device, label: &str, format: TextureFormat, rows: u32) -> Texture {
    device.create_texture(&TextureDescriptor {
        label: Some(label),
        size: Extent3d { width: WIDTH as u32, height: rows, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
        view_formats: &[],
    })
}
