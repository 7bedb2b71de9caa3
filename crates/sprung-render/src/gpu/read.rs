//! The drawn picture copied back from the card.

use std::sync::mpsc::{Receiver, TryRecvError, channel};

use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, COPY_BYTES_PER_ROW_ALIGNMENT, Device, Extent3d, MapMode,
    PollType, Queue, TexelCopyBufferInfo, TexelCopyBufferLayout,
};

use super::target::Target;
use crate::image::Image;

/// A picture on its way back from the card.
#[derive(Debug)]
pub struct Reading {
    device: Device,
    buffer: Buffer,
    size: [u32; 2],
    /// Bytes from one row in the buffer to the next.
    stride: u32,
    /// Hears whether it has come.
    arrived: Receiver<bool>,
}

impl Reading {
    pub(super) fn begin(device: &Device, queue: &Queue, target: &Target) -> Self {
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
        let (sender, arrived) = channel();
        buffer.map_async(MapMode::Read, .., move |result| {
            let _ = sender.send(result.is_ok()); // nobody waits any more if it was given up
        });
        Self { device: device.clone(), buffer, size: target.size, stride, arrived }
    }

    /// Waits for the card, which a browser does not allow: natively only. `None` if the card is gone.
    pub fn wait(self) -> Option<Image> {
        self.device.poll(PollType::wait_indefinitely()).ok()?;
        if self.arrived.recv().ok()? { self.image() } else { None }
    }

    /// Looks whether it has come.
    ///
    /// # Errors
    /// It, if it is still on its way.
    pub fn look(self) -> Result<Option<Image>, Self> {
        if self.device.poll(PollType::Poll).is_err() {
            return Ok(None);
        }
        match self.arrived.try_recv() {
            Ok(true) => Ok(self.image()),
            Ok(false) | Err(TryRecvError::Disconnected) => Ok(None),
            Err(TryRecvError::Empty) => Err(self),
        }
    }

    fn image(&self) -> Option<Image> {
        let [width, height] = self.size;
        let bytes = self.buffer.get_mapped_range(..).ok()?;
        let rows = bytes.chunks_exact(self.stride as usize);
        let pixels = rows.flat_map(|row| row[..4 * width as usize].chunks_exact(4));
        let rgb = pixels.flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        Some(Image { width, height, rgb })
    }
}
