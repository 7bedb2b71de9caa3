//! Pipelines: one for each way of drawing something, all listed in [`Pipe::ALL`].

use wgpu::{
    BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindingType, BlendState,
    BufferBindingType, ColorTargetState, ColorWrites, CompareFunction, DepthBiasState, DepthStencilState,
    Device, FragmentState, MultisampleState, PipelineCompilationOptions, PipelineLayout,
    PipelineLayoutDescriptor, PrimitiveState, PrimitiveTopology, RenderPipeline, RenderPipelineDescriptor,
    SamplerBindingType, ShaderModule, ShaderModuleDescriptor, ShaderSource, ShaderStages, TextureFormat,
    TextureSampleType, TextureViewDimension, VertexAttribute, VertexBufferLayout, VertexFormat, VertexState,
    VertexStepMode,
};

use super::frame;
use super::quality::Quality;
use super::shaders::{self, Shader};

/// Depth of the scene, and of the shadow map.
pub const DEPTH: TextureFormat = TextureFormat::Depth32Float;
/// What egui takes.
pub const FINISHED: TextureFormat = TextureFormat::Rgba8Unorm;

/// A way of drawing something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pipe {
    /// What is behind everything.
    Backdrop,
    /// Spheres.
    Points,
    /// Springs as lines.
    Lines,
    /// Thousands of springs as lines.
    ThinLines,
    /// Springs as coils.
    Coils,
    /// Cloths and skins.
    Surface,
    /// Planes, laid over what is there.
    Ground,
    /// Arrows.
    Arrows,
    /// Depth alone of a ghost's spheres, so that only its front is blended.
    GhostPointsDepth,
    /// Likewise of lines.
    GhostLinesDepth,
    /// Likewise of surfaces.
    GhostSurfaceDepth,
    /// A ghost's spheres, blended.
    GhostPoints,
    /// A ghost's lines.
    GhostLines,
    /// A ghost's surfaces.
    GhostSurface,
    /// Marked springs, hidden by what is in front of them.
    MarkLines,
    /// Marked springs through everything.
    OverLines,
    /// Straight pieces given by their ends, through everything.
    OverSegments,
    /// Rings around points, hidden by what is in front of them.
    MarkRings,
    /// Rings through everything.
    OverRings,
    /// What of spheres the key light sees.
    ShadowPoints,
    /// Likewise of lines.
    ShadowLines,
    /// Likewise of coils.
    ShadowCoils,
    /// Likewise of surfaces.
    ShadowSurface,
}

/// What a vertex buffer holds for each instance.
#[derive(Clone, Copy, PartialEq)]
enum Instances {
    None,
    /// A point's index.
    Index,
    /// A point's index, and its kind and body.
    Ball,
    /// A spring's points and its index.
    Spring,
    /// Two places, m.
    Segment,
}

/// How fragments meet what is there.
#[derive(Clone, Copy, PartialEq)]
enum Layer {
    /// Behind everything.
    Behind,
    /// Solid; with `true`, alpha is the share of the pixel's samples that are covered.
    Solid(bool),
    /// Depth alone.
    DepthOnly,
    /// Blended, hidden by what is in front.
    Blended,
    /// Blended over everything.
    Over,
    /// Into the shadow map.
    Shadow,
}

struct Spec {
    shader: &'static Shader,
    vertex: &'static str,
    fragment: Option<&'static str>,
    instances: Instances,
    strip: bool,
    layer: Layer,
    /// Pushed away, for surfaces on which lines are drawn.
    pushed: bool,
}

impl Pipe {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 23] = [
        Self::Backdrop,
        Self::Points,
        Self::Lines,
        Self::ThinLines,
        Self::Coils,
        Self::Surface,
        Self::Ground,
        Self::Arrows,
        Self::GhostPointsDepth,
        Self::GhostLinesDepth,
        Self::GhostSurfaceDepth,
        Self::GhostPoints,
        Self::GhostLines,
        Self::GhostSurface,
        Self::MarkLines,
        Self::OverLines,
        Self::OverSegments,
        Self::MarkRings,
        Self::OverRings,
        Self::ShadowPoints,
        Self::ShadowLines,
        Self::ShadowCoils,
        Self::ShadowSurface,
    ];

    fn spec(self) -> Spec {
        let quads = |shader, vertex, fragment, instances, layer| Spec {
            shader,
            vertex,
            fragment: Some(fragment),
            instances,
            strip: true,
            layer,
            pushed: false,
        };
        let triangles = |shader, instances, layer| Spec {
            shader,
            vertex: "vs_main",
            fragment: Some("fs_main"),
            instances,
            strip: false,
            layer,
            pushed: false,
        };
        let points = |layer| quads(&shaders::POINTS, "vs_main", "fs_main", Instances::Ball, layer);
        let springs =
            |fragment, layer| quads(&shaders::LINES, "vs_spring", fragment, Instances::Spring, layer);
        let surface = |layer| Spec { pushed: true, ..triangles(&shaders::SURFACE, Instances::None, layer) };
        let rings = |layer| quads(&shaders::RINGS, "vs_main", "fs_main", Instances::Index, layer);
        match self {
            Self::Backdrop => triangles(&shaders::BACKDROP, Instances::None, Layer::Behind),
            Self::Points => points(Layer::Solid(true)),
            Self::Lines => springs("fs_main", Layer::Solid(true)),
            Self::ThinLines => Spec { vertex: "vs_thin", ..springs("fs_thin", Layer::Solid(false)) },
            Self::Coils => triangles(&shaders::COILS, Instances::Spring, Layer::Solid(false)),
            Self::Surface => surface(Layer::Solid(false)),
            Self::Ground => quads(&shaders::GROUND, "vs_main", "fs_main", Instances::None, Layer::Blended),
            Self::Arrows => triangles(&shaders::ARROWS, Instances::Index, Layer::Solid(false)),
            Self::GhostPointsDepth => points(Layer::DepthOnly),
            Self::GhostLinesDepth => springs("fs_flat", Layer::DepthOnly),
            Self::GhostSurfaceDepth => surface(Layer::DepthOnly),
            Self::GhostPoints => points(Layer::Blended),
            Self::GhostLines => springs("fs_flat", Layer::Blended),
            Self::GhostSurface => surface(Layer::Blended),
            Self::MarkLines => springs("fs_flat", Layer::Blended),
            Self::OverLines => springs("fs_flat", Layer::Over),
            Self::OverSegments => {
                quads(&shaders::LINES, "vs_segment", "fs_flat", Instances::Segment, Layer::Over)
            }
            Self::MarkRings => rings(Layer::Blended),
            Self::OverRings => rings(Layer::Over),
            Self::ShadowPoints => {
                quads(&shaders::POINTS, "vs_shadow", "fs_shadow", Instances::Ball, Layer::Shadow)
            }
            Self::ShadowLines => Spec {
                fragment: None,
                ..quads(&shaders::LINES, "vs_shadow", "", Instances::Spring, Layer::Shadow)
            },
            Self::ShadowCoils => Spec {
                vertex: "vs_shadow",
                fragment: None,
                ..triangles(&shaders::COILS, Instances::Spring, Layer::Shadow)
            },
            Self::ShadowSurface => Spec {
                vertex: "vs_shadow",
                fragment: Some("fs_shadow"),
                ..triangles(&shaders::SURFACE, Instances::None, Layer::Shadow)
            },
        }
    }
}

/// All pipelines, and the layouts of what they bind.
pub struct Pipelines {
    /// Group 0: the frame and the tables.
    pub tables: BindGroupLayout,
    /// Group 1: a style, at an offset.
    pub style: BindGroupLayout,
    /// Group 2: the shadow map.
    pub shadow: BindGroupLayout,
    /// The last pass's group 0: what was drawn.
    pub drawn: BindGroupLayout,
    /// The last pass.
    pub finish: RenderPipeline,
    all: Vec<RenderPipeline>,
}

impl Pipelines {
    /// Compiles all of them.
    pub fn new(device: &Device, quality: Quality) -> Self {
        let tables = layout(device, "tables", &table_entries());
        let uniform = uniform(ShaderStages::VERTEX_FRAGMENT, true, 128);
        let style = layout(device, "style", &[uniform]);
        let map = texture(ShaderStages::FRAGMENT, TextureSampleType::Depth);
        let sampler = BindingType::Sampler(SamplerBindingType::Comparison);
        let shadow = layout(device, "shadow map", &[map, (ShaderStages::FRAGMENT, sampler)]);
        let sampled = TextureSampleType::Float { filterable: false };
        let drawn = layout(device, "drawn", &[texture(ShaderStages::FRAGMENT, sampled)]);
        let pipeline_layout = |label, groups: &[Option<&BindGroupLayout>]| {
            let descriptor = PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: groups,
                immediate_size: 0,
            };
            device.create_pipeline_layout(&descriptor)
        };
        let scene = pipeline_layout("scene", &[Some(&tables), Some(&style), Some(&shadow)]);
        let light = pipeline_layout("what the light sees", &[Some(&tables), Some(&style)]);
        let last = pipeline_layout("finish", &[Some(&drawn)]);

        let mut modules: Vec<(&str, ShaderModule)> = Vec::new();
        let mut all = Vec::with_capacity(Pipe::ALL.len());
        for pipe in Pipe::ALL {
            let spec = pipe.spec();
            if !modules.iter().any(|(name, _)| *name == spec.shader.name) {
                modules.push((spec.shader.name, module(device, spec.shader)));
            }
            let Some((_, module)) = modules.iter().find(|(name, _)| *name == spec.shader.name) else {
                continue;
            };
            let layout = if spec.layer == Layer::Shadow { &light } else { &scene };
            all.push(make(device, &format!("{pipe:?}"), &spec, module, layout, quality));
        }
        let finish = make_finish(device, &last, quality);
        Self { tables, style, shadow, drawn, finish, all }
    }

    /// One of them.
    pub fn get(&self, pipe: Pipe) -> &RenderPipeline {
        &self.all[pipe as usize]
    }
}

type Entry = (ShaderStages, BindingType);

/// The frame, and the tables in the order of common.wgsl.
fn table_entries() -> Vec<Entry> {
    let float = texture(ShaderStages::VERTEX, TextureSampleType::Float { filterable: false });
    let whole = texture(ShaderStages::VERTEX, TextureSampleType::Uint);
    let frame = uniform(ShaderStages::VERTEX_FRAGMENT, false, frame::BYTES);
    vec![frame, float, float, float, float, whole, whole, whole]
}

fn uniform(stages: ShaderStages, has_dynamic_offset: bool, bytes: u64) -> Entry {
    let ty = BufferBindingType::Uniform;
    (
        stages,
        BindingType::Buffer { ty, has_dynamic_offset, min_binding_size: std::num::NonZeroU64::new(bytes) },
    )
}

fn texture(stages: ShaderStages, sample_type: TextureSampleType) -> Entry {
    let view_dimension = TextureViewDimension::D2;
    (stages, BindingType::Texture { sample_type, view_dimension, multisampled: false })
}

fn layout(device: &Device, label: &str, entries: &[Entry]) -> BindGroupLayout {
    let entries: Vec<BindGroupLayoutEntry> = entries
        .iter()
        .zip(0..)
        .map(|(&(visibility, ty), binding)| BindGroupLayoutEntry { binding, visibility, ty, count: None })
        .collect();
    device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
}

fn module(device: &Device, shader: &Shader) -> ShaderModule {
    device.create_shader_module(ShaderModuleDescriptor {
        label: Some(shader.name),
        source: ShaderSource::Wgsl(shader.text.into()),
    })
}

fn make(
    device: &Device,
    label: &str,
    spec: &Spec,
    module: &ShaderModule,
    layout: &PipelineLayout,
    quality: Quality,
) -> RenderPipeline {
    let constants = quality.constants();
    let options = || PipelineCompilationOptions { constants: &constants, ..Default::default() };
    let attribute = |format, offset, shader_location| VertexAttribute { format, offset, shader_location };
    let (stride, attributes): (u64, &[VertexAttribute]) = match spec.instances {
        Instances::None => (0, &[]),
        Instances::Index => (4, &[attribute(VertexFormat::Uint32, 0, 0)]),
        Instances::Ball => (8, &[attribute(VertexFormat::Uint32x2, 0, 0)]),
        Instances::Spring => (12, &[attribute(VertexFormat::Uint32x3, 0, 0)]),
        Instances::Segment => {
            (24, &[attribute(VertexFormat::Float32x3, 0, 0), attribute(VertexFormat::Float32x3, 12, 1)])
        }
    };
    let buffer = VertexBufferLayout { array_stride: stride, step_mode: VertexStepMode::Instance, attributes };
    let buffers = [Some(buffer)];
    let is_shadow = spec.layer == Layer::Shadow;
    let target = ColorTargetState {
        format: quality.colour(),
        blend: matches!(spec.layer, Layer::Blended | Layer::Over).then_some(BlendState::ALPHA_BLENDING),
        write_mask: if spec.layer == Layer::DepthOnly { ColorWrites::empty() } else { ColorWrites::ALL },
    };
    let targets = [Some(target)];
    let fragment = spec.fragment.map(|entry| FragmentState {
        module,
        entry_point: Some(entry),
        compilation_options: options(),
        targets: if is_shadow { &[] } else { &targets },
    });
    // Depth is near/z: what is nearer is larger. In the shadow map it is the other way round.
    let compare = match spec.layer {
        Layer::Behind | Layer::Over => CompareFunction::Always,
        Layer::Shadow => CompareFunction::Less,
        Layer::Solid(_) | Layer::DepthOnly | Layer::Blended => CompareFunction::GreaterEqual,
    };
    let bias = match (spec.pushed, is_shadow) {
        (true, _) => DepthBiasState { constant: -2, slope_scale: -1.0, clamp: 0.0 },
        (_, true) => DepthBiasState { constant: 0, slope_scale: 1.5, clamp: 0.0 },
        _ => DepthBiasState::default(),
    };
    device.create_render_pipeline(&RenderPipelineDescriptor {
        label: Some(label),
        layout: Some(layout),
        vertex: VertexState {
            module,
            entry_point: Some(spec.vertex),
            compilation_options: options(),
            buffers: if spec.instances == Instances::None { &[] } else { &buffers },
        },
        primitive: PrimitiveState {
            topology: if spec.strip {
                PrimitiveTopology::TriangleStrip
            } else {
                PrimitiveTopology::TriangleList
            },
            ..Default::default()
        },
        depth_stencil: Some(DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(matches!(
                spec.layer,
                Layer::Solid(_) | Layer::DepthOnly | Layer::Shadow
            )),
            depth_compare: Some(compare),
            stencil: Default::default(),
            bias,
        }),
        multisample: MultisampleState {
            count: if is_shadow { 1 } else { quality.samples() },
            alpha_to_coverage_enabled: spec.layer == Layer::Solid(true) && quality.samples() > 1,
            ..Default::default()
        },
        fragment,
        multiview_mask: None,
        cache: None,
    })
}

fn make_finish(device: &Device, layout: &PipelineLayout, quality: Quality) -> RenderPipeline {
    let module = module(device, &shaders::FINISH);
    let constants = quality.constants();
    let options = || PipelineCompilationOptions { constants: &constants, ..Default::default() };
    device.create_render_pipeline(&RenderPipelineDescriptor {
        label: Some("finish"),
        layout: Some(layout),
        vertex: VertexState {
            module: &module,
            entry_point: Some("vs_main"),
            compilation_options: options(),
            buffers: &[],
        },
        primitive: PrimitiveState::default(),
        depth_stencil: None,
        multisample: MultisampleState::default(),
        fragment: Some(FragmentState {
            module: &module,
            entry_point: Some("fs_main"),
            compilation_options: options(),
            targets: &[Some(FINISHED.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_is_in_the_order_of_the_numbers() {
        for (index, pipe) in Pipe::ALL.into_iter().enumerate() {
            assert_eq!(pipe as usize, index, "{pipe:?}");
        }
    }
}
