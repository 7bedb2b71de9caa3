//! The three passes of a picture: what the key light sees, the scene, and the last one for egui.

use sprung::{Model, Params};
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindingResource, Color, CommandEncoder, CompareFunction,
    Device, FilterMode, IndexFormat, LoadOp, Operations, Queue, RenderPass, RenderPassColorAttachment,
    RenderPassDepthStencilAttachment, RenderPassDescriptor, SamplerDescriptor, StoreOp, TextureUsages,
    TextureView,
};

use super::Moment;
use super::data::{Data, List, STYLE_STRIDE, Source};
use super::pipelines::{DEPTH, Pipe, Pipelines};
use super::quality::Quality;
use super::scenery::Sizes;
use super::target::{self, Target};
use crate::appearance::Appearance;
use crate::camera::{Bounds, Camera};

/// All that decides how one picture looks.
pub struct Lens<'a> {
    /// From where.
    pub camera: &'a Camera,
    /// How.
    pub appearance: &'a Appearance,
    /// When.
    pub moment: &'a Moment<'a>,
    /// The box around what is there, m.
    pub bounds: &'a Bounds,
    /// How large things are drawn.
    pub sizes: Sizes,
    /// The parameters; none if there is nothing to draw.
    pub params: Option<&'a Params>,
    /// The model.
    pub model: Option<&'a Model>,
}

/// What a drawing takes from buffers.
#[derive(Clone)]
pub enum Mesh<'a> {
    /// So many vertices, numbered.
    Vertices(u32),
    /// So many for each entry of a list.
    Instances(u32, &'a List),
    /// Triangles of points, by their corners.
    Corners(&'a List, std::ops::Range<u32>),
    /// All triangles of the first list for each entry of the second.
    Copies(&'a List, &'a List),
}

/// One drawing.
#[derive(Clone)]
pub struct Call<'a> {
    /// How.
    pub pipe: Pipe,
    /// Which positions it reads.
    pub source: Source,
    /// Which style.
    pub style: usize,
    /// What.
    pub mesh: Mesh<'a>,
}

/// Pipelines, and the shadow map.
pub struct Passes {
    /// All pipelines.
    pub pipelines: Pipelines,
    shadow_map: TextureView,
    shadow_group: BindGroup,
}

impl Passes {
    /// Compiles all shaders.
    pub fn new(device: &Device, quality: Quality) -> Self {
        let pipelines = Pipelines::new(device, quality);
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        let shadow_map = target::make(device, "shadow map", [quality.shadow_side(); 2], DEPTH, 1, usage);
        let shadow_map = shadow_map.create_view(&Default::default());
        let sampler = device.create_sampler(&SamplerDescriptor {
            label: Some("shadow map"),
            mag_filter: FilterMode::Linear,
            min_filter: FilterMode::Linear,
            compare: Some(CompareFunction::LessEqual),
            ..Default::default()
        });
        let shadow_group = device.create_bind_group(&BindGroupDescriptor {
            label: Some("shadow map"),
            layout: &pipelines.shadow,
            entries: &[
                BindGroupEntry { binding: 0, resource: BindingResource::TextureView(&shadow_map) },
                BindGroupEntry { binding: 1, resource: BindingResource::Sampler(&sampler) },
            ],
        });
        Self { pipelines, shadow_map, shadow_group }
    }

    /// Records all three passes and hands them to the card.
    pub fn encode(&self, device: &Device, queue: &Queue, data: &Data, target: &Target, calls: &[Call<'_>]) {
        let mut encoder = device.create_command_encoder(&Default::default());
        self.shadow_pass(&mut encoder, data, calls);
        self.scene_pass(&mut encoder, data, target, calls);
        self.finish_pass(&mut encoder, target);
        queue.submit([encoder.finish()]);
    }

    fn shadow_pass(&self, encoder: &mut CommandEncoder, data: &Data, calls: &[Call<'_>]) {
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("what the key light sees"),
            color_attachments: &[],
            depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
                view: &self.shadow_map,
                depth_ops: Some(Operations { load: LoadOp::Clear(1.0), store: StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        calls.iter().filter(|call| is_shadow(call.pipe)).for_each(|call| self.record(&mut pass, data, call));
    }

    fn scene_pass(&self, encoder: &mut CommandEncoder, data: &Data, target: &Target, calls: &[Call<'_>]) {
        // Of several samples only their mean is kept.
        let store = if target.samples.is_some() { StoreOp::Discard } else { StoreOp::Store };
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &[Some(RenderPassColorAttachment {
                view: target.samples.as_ref().unwrap_or(&target.resolved),
                depth_slice: None,
                resolve_target: target.samples.as_ref().map(|_| &target.resolved),
                ops: Operations { load: LoadOp::Clear(Color::BLACK), store },
            })],
            depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
                view: &target.depth,
                depth_ops: Some(Operations { load: LoadOp::Clear(0.0), store: StoreOp::Discard }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_bind_group(2, &self.shadow_group, &[]);
        calls.iter().filter(|call| !is_shadow(call.pipe)).for_each(|call| self.record(&mut pass, data, call));
    }

    fn finish_pass(&self, encoder: &mut CommandEncoder, target: &Target) {
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("finish"),
            color_attachments: &[Some(RenderPassColorAttachment {
                view: &target.finished_view,
                depth_slice: None,
                resolve_target: None,
                ops: Operations { load: LoadOp::Clear(Color::BLACK), store: StoreOp::Store },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipelines.finish);
        pass.set_bind_group(0, &target.drawn, &[]);
        pass.draw(0..3, 0..1);
    }

    fn record(&self, pass: &mut RenderPass<'_>, data: &Data, call: &Call<'_>) {
        let Some(tables) = data.tables(call.source) else { return };
        pass.set_pipeline(self.pipelines.get(call.pipe));
        pass.set_bind_group(0, tables, &[]);
        pass.set_bind_group(1, data.styles(), &[(call.style as u64 * STYLE_STRIDE) as u32]);
        match &call.mesh {
            Mesh::Vertices(count) => pass.draw(0..*count, 0..1),
            Mesh::Instances(vertices, list) => {
                let Some(buffer) = &list.buffer else { return };
                pass.set_vertex_buffer(0, buffer.slice(..));
                pass.draw(0..*vertices, 0..list.count);
            }
            Mesh::Corners(list, range) => {
                let Some(buffer) = &list.buffer else { return };
                pass.set_index_buffer(buffer.slice(..), IndexFormat::Uint32);
                pass.draw_indexed(range.start..range.end.min(list.count), 0, 0..1);
            }
            Mesh::Copies(corners, list) => {
                let (Some(indices), Some(instances)) = (&corners.buffer, &list.buffer) else { return };
                pass.set_index_buffer(indices.slice(..), IndexFormat::Uint32);
                pass.set_vertex_buffer(0, instances.slice(..));
                pass.draw_indexed(0..corners.count, 0, 0..list.count);
            }
        }
    }
}

fn is_shadow(pipe: Pipe) -> bool {
    matches!(pipe, Pipe::ShadowPoints | Pipe::ShadowLines | Pipe::ShadowCoils | Pipe::ShadowSurface)
}
