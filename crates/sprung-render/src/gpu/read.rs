//! The drawn picture copied back from the card.

use wgpu::{
    BufferDescriptor, BufferUsages, COPY_BYTES_PER_ROW_ALIGNMENT, Device, Extent3d, MapMode, PollType, Queue,
    TexelCopyBufferInfo, TexelCopyBufferLayout,
};

use super::target::Target;
use crate::image::Image;

/// Waits for the card and copies the picture; `None` if the card is gone.
pub fn read(device: &Device, queue: &Queue, target: &Target) -> Option<Image> {
    let [width, height] = target.size;
    // Rows in a buffer begin at multiples of 256 bytes.
    let stride = (4 * width).next_multiple_of(COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = device.create_buffer(&BufferDescriptor {
        label: Some("picture"),
        size: u64::from(stride) * u64::from(height),
        usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(stride), rows_per_image: None };
    let mut encoder = device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        target.finished.as_image_copy(),
        TexelCopyBufferInfo { buffer: &buffer, layout },
        Extent3d { width, height, depth_or_array_layers: 1 },
    );
    queue.submit([encoder.finish()]);
    let (sender, receiver) = std::sync::mpsc::channel();
    buffer.map_async(MapMode::Read, .., move |result| {
        let _ = sender.send(result.is_ok()); // nobody waits if the poll below failed
    });
    device.poll(PollType::wait_indefinitely()).ok()?;
    if !receiver.recv().ok()? {
        return None;
    }
    let bytes = buffer.get_mapped_range(..).ok()?;
    let rows = bytes.chunks_exact(stride as usize);
    let pixels = rows.flat_map(|row| row[..4 * width as usize].chunks_exact(4));
    let rgb = pixels.flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    Some(Image { width, height, rgb })
}
