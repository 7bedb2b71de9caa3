//! What the card holds of a model: the tables that shaders read, the lists of what is drawn, and styles.

use glam::Vec3;
use sprung::{Model, Params};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindingResource, Buffer, BufferBinding,
    BufferDescriptor, BufferUsages, Device, Queue, TextureFormat,
};

use super::Moment;
use super::frame::{self, Row};
use super::table::Table;
use super::topology::Rims;
use crate::camera::Bounds;

/// Styles of one picture.
pub const MOST_STYLES: usize = 64;
/// Distance of styles in their buffer, bytes: what every device allows as an offset.
pub const STYLE_STRIDE: u64 = 256;

/// What differs from drawing to drawing: the struct `Style` of common.wgsl.
#[derive(Clone, Copy, Debug, Default)]
pub struct Style {
    /// Mostly a colour and its opacity.
    pub colour: Row,
    /// The other side's.
    pub back: Row,
    /// The grid's.
    pub line: Row,
    /// The shadow's.
    pub dark: Row,
    /// Sizes.
    pub size: Row,
    /// A plane's middle and reach.
    pub origin: Row,
    /// Its first axis, and the distance of the grid's lines.
    pub along_u: Row,
    /// Its second axis.
    pub along_v: Row,
}

impl Style {
    fn rows(&self) -> [Row; 16] {
        let mut rows = [[0.0; 4]; 16];
        let own = [
            self.colour,
            self.back,
            self.line,
            self.dark,
            self.size,
            self.origin,
            self.along_u,
            self.along_v,
        ];
        rows[..8].copy_from_slice(&own);
        rows
    }
}

/// Which positions a drawing reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Those of the moment.
    Now,
    /// Those of the earlier run.
    Ghost,
}

/// A list for vertex or index buffers, empty or filled.
#[derive(Default)]
pub struct List {
    /// Its buffer; none if it is empty.
    pub buffer: Option<Buffer>,
    /// Entries.
    pub count: u32,
}

impl List {
    /// Uploads entries. What a buffer of this device cannot hold is left out.
    pub fn new<T: bytemuck::Pod>(device: &Device, entries: &[T], usage: BufferUsages) -> Self {
        let most =
            (device.limits().max_buffer_size / size_of::<T>() as u64).min(u64::from(u32::MAX)) as usize;
        let entries = &entries[..entries.len().min(most)];
        if entries.is_empty() {
            return Self::default();
        }
        let contents = bytemuck::cast_slice(entries);
        let buffer = device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage });
        Self { buffer: Some(buffer), count: entries.len() as u32 }
    }

    /// Uploads what vertex shaders take one of for each instance.
    pub fn instances<T: bytemuck::Pod>(device: &Device, entries: &[T]) -> Self {
        Self::new(device, entries, BufferUsages::VERTEX)
    }
}

/// The tables and uniforms of one model.
pub struct Data {
    positions: Table,
    ghost: Table,
    springs: Table,
    velocities: Table,
    forces: Table,
    rims: Table,
    fans: Table,
    spokes: Table,
    frame: Buffer,
    styles: Buffer,
    /// Group 0 for the moment and for the ghost; none after a table has grown.
    groups: Option<[BindGroup; 2]>,
    style_group: BindGroup,
    staging: Vec<Row>,
}

impl Data {
    /// Empty tables.
    pub fn new(device: &Device, style_layout: &BindGroupLayout) -> Self {
        let table = |label, format| Table::new(device, label, format);
        let uniform = |label, size| {
            let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
            device.create_buffer(&BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let styles = uniform("styles", STYLE_STRIDE * MOST_STYLES as u64);
        let size = std::num::NonZeroU64::new(128);
        let style_group = device.create_bind_group(&BindGroupDescriptor {
            label: Some("style"),
            layout: style_layout,
            entries: &[BindGroupEntry {
                binding: 0,
                resource: BindingResource::Buffer(BufferBinding { buffer: &styles, offset: 0, size }),
            }],
        });
        Self {
            positions: table("positions", TextureFormat::Rgba32Float),
            ghost: table("ghost", TextureFormat::Rgba32Float),
            springs: table("springs", TextureFormat::Rg32Float),
            velocities: table("velocities", TextureFormat::Rgba32Float),
            forces: table("forces", TextureFormat::Rgba32Float),
            rims: table("rims", TextureFormat::Rgba32Uint),
            fans: table("fans", TextureFormat::Rg32Uint),
            spokes: table("spokes", TextureFormat::Rg32Uint),
            frame: uniform("frame", frame::BYTES),
            styles,
            groups: None,
            style_group,
            staging: Vec::new(),
        }
    }

    /// Takes the topology of a model.
    pub fn set_model(&mut self, device: &Device, queue: &Queue, model: &Model) {
        let found = Rims::new(model, Table::most(device));
        let mut grown = self.rims.make_room(device, found.rims.len());
        grown |= self.fans.make_room(device, found.fans.len());
        grown |= self.spokes.make_room(device, found.spokes.len());
        grown |= self.positions.make_room(device, found.rims.len());
        grown |= self.springs.make_room(device, model.spring_count());
        if grown {
            self.groups = None;
        }
        self.rims.write(queue, &found.rims);
        self.fans.write(queue, &found.fans);
        self.spokes.write(queue, &found.spokes);
    }

    /// Takes stiffness and rest length of all springs; those that are cut have a rest length below zero.
    pub fn set_springs(&mut self, queue: &Queue, params: &Params) {
        let constants = params.spring_stiffness.iter().zip(&*params.spring_rest_length);
        let rows: Vec<[f32; 2]> = constants
            .zip(&*params.spring_cut)
            .map(|((&stiffness, &rest), &cut)| [stiffness, if cut { -1.0 - rest } else { rest }])
            .collect();
        self.springs.write(queue, &rows);
    }

    /// Uploads a moment's positions, blended between its two steps, and gives the box around them.
    pub fn set_positions(&mut self, queue: &Queue, moment: &Moment<'_>, openness: &[f32]) -> Bounds {
        let mut bounds = Bounds::default();
        let blend = if moment.blend.is_finite() { moment.blend.clamp(0.0, 1.0) } else { 1.0 };
        self.staging.clear();
        let open = openness.iter().copied().chain(std::iter::repeat(1.0));
        let now = moment.now.iter().zip(open);
        if moment.before.len() == moment.now.len() && blend < 1.0 {
            let pairs = now.zip(moment.before);
            let rows =
                pairs.map(|((now, open), before)| present(before.lerp(*now, blend), open, &mut bounds));
            self.staging.extend(rows);
        } else {
            self.staging.extend(now.map(|(now, open)| present(*now, open, &mut bounds)));
        }
        self.positions.write(queue, &self.staging);
        bounds
    }

    /// Uploads the positions of a ghost, and grows the box by them.
    pub fn set_ghost(&mut self, device: &Device, queue: &Queue, positions: &[Vec3], bounds: &mut Bounds) {
        fill(&mut self.ghost, &mut self.staging, &mut self.groups, device, queue, positions, bounds);
    }

    /// Uploads velocities, m/s.
    pub fn set_velocities(&mut self, device: &Device, queue: &Queue, vectors: &[Vec3]) {
        let ignored = &mut Bounds::default();
        fill(&mut self.velocities, &mut self.staging, &mut self.groups, device, queue, vectors, ignored);
    }

    /// Uploads forces, N.
    pub fn set_forces(&mut self, device: &Device, queue: &Queue, vectors: &[Vec3]) {
        let ignored = &mut Bounds::default();
        fill(&mut self.forces, &mut self.staging, &mut self.groups, device, queue, vectors, ignored);
    }

    /// Uploads what all shaders know, and the styles of the drawings.
    pub fn set_uniforms(&self, queue: &Queue, frame: &[Row], styles: &[Style]) {
        queue.write_buffer(&self.frame, 0, bytemuck::cast_slice(frame));
        let rows: Vec<Row> = styles.iter().take(MOST_STYLES).flat_map(Style::rows).collect();
        queue.write_buffer(&self.styles, 0, bytemuck::cast_slice(&rows));
    }

    /// Binds the tables anew if one of them has grown.
    pub fn bind(&mut self, device: &Device, layout: &BindGroupLayout) {
        if self.groups.is_some() {
            return;
        }
        let group = |label, positions: &Table| {
            let tables = [
                positions,
                &self.springs,
                &self.velocities,
                &self.forces,
                &self.rims,
                &self.fans,
                &self.spokes,
            ];
            let mut entries = vec![BindGroupEntry { binding: 0, resource: self.frame.as_entire_binding() }];
            entries.extend(tables.iter().zip(1..).map(|(table, binding)| BindGroupEntry {
                binding,
                resource: BindingResource::TextureView(&table.view),
            }));
            device.create_bind_group(&BindGroupDescriptor { label: Some(label), layout, entries: &entries })
        };
        self.groups = Some([group("now", &self.positions), group("ghost", &self.ghost)]);
    }

    /// The tables as a drawing reads them.
    pub fn tables(&self, source: Source) -> Option<&BindGroup> {
        let [now, ghost] = self.groups.as_ref()?;
        Some(if source == Source::Now { now } else { ghost })
    }

    /// The styles, to be bound at an offset.
    pub fn styles(&self) -> &BindGroup {
        &self.style_group
    }
}

/// A row for a place that exists, or an empty one for a place that is not finite.
fn present(place: Vec3, open: f32, bounds: &mut Bounds) -> Row {
    if !place.is_finite() {
        return [0.0; 4];
    }
    bounds.include(place);
    frame::row(place, open)
}

fn fill(
    table: &mut Table,
    staging: &mut Vec<Row>,
    groups: &mut Option<[BindGroup; 2]>,
    device: &Device,
    queue: &Queue,
    vectors: &[Vec3],
    bounds: &mut Bounds,
) {
    if table.make_room(device, vectors.len()) {
        *groups = None;
    }
    staging.clear();
    staging.extend(vectors.iter().map(|vector| present(*vector, 1.0, bounds)));
    table.write(queue, staging);
}
