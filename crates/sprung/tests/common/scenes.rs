//! The four scenes of docs/method.md, written out for the twin, with how many springs each has.

use super::twin::{Ground, Twin, V3, add, dot, scale};

/// A scene of the report.
pub struct Scene {
    pub name: &'static str,
    pub twin: Twin,
    pub dt: f64,
    pub substeps: u32,
    pub springs: usize,
}

pub fn four() -> [Scene; 4] {
    [spring(), chain(), jelly(), cloth()]
}

fn empty() -> Twin {
    Twin { g: 9.81, ..Twin::default() }
}

pub fn spring() -> Scene {
    let mut twin = empty();
    twin.add_point(0.0, [0.0, 0.0, 0.0], [0.0; 3]);
    twin.add_point(1.0, [0.0, -5.0, 0.0], [5.0, 0.0, 0.0]);
    twin.create_springs(5.0, 1.0, 0.2);
    Scene { name: "spring", twin, dt: 0.01, substeps: 7, springs: 1 }
}

pub fn chain() -> Scene {
    let mut twin = empty();
    for i in 0..15 {
        let mass = if i == 0 { 0.0 } else { 1.0 };
        twin.add_point(mass, [2.0 * i as f64, 25.0, 0.0], [0.0; 3]);
    }
    twin.create_springs(2.0, 200.0, 3.0);
    Scene { name: "chain", twin, dt: 0.01, substeps: 7, springs: 14 }
}

pub fn jelly() -> Scene {
    let mut twin = empty();
    let u = scale([1.0, 1.0, 1.0], 1.0 / 3f64.sqrt());
    for i in 0..10 {
        for j in 0..10 {
            for k in 0..10 {
                let corner = [2.0 * i as f64 - 10.0, 2.0 * j as f64, 2.0 * k as f64];
                twin.add_point(1.0, rotate(corner, u, 12.5f64.to_radians()), [0.0; 3]);
            }
        }
    }
    twin.create_springs(8f64.sqrt() + 0.001, 750.0, 10.0);
    twin.ground = Some(Ground { y: -10.0, kc: 50.0, kcd: 10.0 });
    Scene { name: "jelly", twin, dt: 0.01, substeps: 11, springs: 7560 }
}

pub fn cloth() -> Scene {
    let mut twin = empty();
    for j in 0..20 {
        for i in 0..20 {
            let corner = i == 0 && (j == 0 || j == 19);
            let mass = if corner { 0.0 } else { 0.5 };
            twin.add_point(mass, [2.0 * j as f64 - 20.0, 10.0, 2.0 * i as f64], [0.0; 3]);
        }
    }
    twin.create_springs(8f64.sqrt() + 0.001, 600.0, 3.0);
    Scene { name: "cloth", twin, dt: 0.01, substeps: 7, springs: 1482 }
}

/// Rotation by an angle (rad) about a unit axis: the part along the axis stays, the part across it turns.
fn rotate(p: V3, u: V3, angle: f64) -> V3 {
    let along = scale(u, dot(p, u));
    let across = add(p, scale(along, -1.0));
    let sideways = [u[1] * p[2] - u[2] * p[1], u[2] * p[0] - u[0] * p[2], u[0] * p[1] - u[1] * p[0]];
    add(along, add(scale(across, angle.cos()), scale(sideways, angle.sin())))
}

/// The engine's simulation of a scene.
pub fn engine(scene: &Scene) -> sprung::Simulation {
    use sprung::{ContactLaw, Material, ModelBuilder, Plane, Simulation, Vec3};
    let vector = |v: V3| Vec3::new(v[0] as f32, v[1] as f32, v[2] as f32);
    let mut builder = ModelBuilder::new();
    for (index, point) in scene.twin.points.iter().enumerate() {
        builder.add_point(vector(point.x), point.m as f32).expect("allowed");
        builder.set_velocity(index, vector(point.v)).expect("allowed");
    }
    let first = &scene.twin.springs[0];
    let material = Material { stiffness: first.ks as f32, damping: first.kd as f32 };
    let radius = match scene.name {
        "spring" => 5.0,
        "chain" => 2.0,
        _ => 8f32.sqrt() + 0.001,
    };
    builder.connect_within(0..scene.twin.points.len(), radius, material).expect("allowed");
    let (model, mut params, state) = builder.build().expect("there are points");
    params.dt = scene.dt;
    params.substeps = scene.substeps;
    if let Some(ground) = &scene.twin.ground {
        let plane = Plane::level(ground.y as f32, ground.kc as f32, ground.kcd as f32);
        params.planes = vec![Plane { law: ContactLaw::Report, ..plane }];
    }
    Simulation::new(model, params, state).expect("the parts fit")
}
