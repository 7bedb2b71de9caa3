//! Filling: the energy of the material at any spacing, and a surface that goes where its points go.

use super::*;
use glam::{DMat3, Vec3};

const MATERIAL: SoftMaterial =
    SoftMaterial { spacing: 0.1, density: 1000.0, stiffness: 2e4, damping: 0.01, merge: None };

/// A closed surface of triangles: an octahedron, each face divided into four `times` over and pushed out to a sphere.
fn ball(times: usize) -> Mesh {
    let mut mesh = Mesh {
        positions: vec![DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z],
        ..Mesh::default()
    };
    let top = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4]];
    let mut faces: Vec<[u32; 3]> = top.into_iter().chain(top.map(|[a, b, _]| [b, a, 5])).collect();
    for _ in 0..times {
        let mut finer = Vec::new();
        for [a, b, c] in faces {
            // Each middle is made twice: merging has something to do.
            let mut middle = |i: u32, j: u32| {
                let place = mesh.positions[i as usize] + mesh.positions[j as usize];
                mesh.positions.push(place.normalize());
                mesh.positions.len() as u32 - 1
            };
            let [d, e, f] = [middle(a, b), middle(b, c), middle(c, a)];
            finer.extend([[a, d, f], [d, b, e], [f, e, c], [d, e, f]]);
        }
        faces = finer;
    }
    faces.iter().for_each(|face| mesh.faces.push(face));
    mesh
}

#[test]
fn a_filled_ball_holds_the_energy_of_its_material_at_any_spacing() {
    let mesh = ball(3);
    for spacing in [0.5, 0.23, 0.11] {
        let body = soft_body(&mesh, &SoftMaterial { spacing, ..MATERIAL }).expect("closed");
        let mass: f64 = body.masses.iter().sum();
        let volume = mass / MATERIAL.density;
        // The ball's own volume, exactly; a polyhedron of 512 faces has a little less than 4π/3.
        assert!((4.0..4.19).contains(&volume), "{volume}");
        // ½(λ·tr² + 2μ·tr(ε²))·V with λ = μ = 0.4·E, for a stretch along x and a shear in xz.
        for (strain, exact) in [
            (DMat3::from_diagonal(DVec3::X), 0.5 * 0.4 * 3.0),
            (DMat3::from_cols(DVec3::Z, DVec3::ZERO, DVec3::X) * 0.5, 0.5 * 0.4),
        ] {
            let energy: f64 = body
                .springs
                .iter()
                .map(|spring| {
                    let [a, b] = spring.ends.map(|point| body.points[point as usize]);
                    let stretch = (b - a).dot(strain * (b - a)) / (b - a).length();
                    0.5 * spring.stiffness * stretch * stretch
                })
                .sum();
            let exact = exact * MATERIAL.stiffness * volume;
            assert!((energy / exact - 1.0).abs() < 1e-9, "{spacing}: {energy} {exact}");
        }
    }
}

#[test]
fn the_surface_is_where_it_was_and_turns_as_one_piece() {
    let mesh = ball(2);
    let body = soft_body(&mesh, &SoftMaterial { spacing: 0.3, ..MATERIAL }).expect("closed");
    let vertices = body.surface.expect("it has one").vertices.expect("weighted");
    assert_eq!(vertices.len(), mesh.positions.len());
    let turn = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 1.0);
    for (turn, shift) in [(DMat3::IDENTITY, DVec3::ZERO), (turn, DVec3::new(100.0, -7.0, 3.0))] {
        let moved = |p: DVec3| (turn * p + shift).as_vec3();
        let points: Vec<Vec3> = body.points.iter().map(|&p| moved(p)).collect();
        for (vertex, &place) in vertices.iter().zip(&mesh.positions) {
            // Points are rounded to float32, 4e-6 at 100 m, and the weights once more.
            let tolerance = 2.0 * f32::EPSILON * (shift.length() as f32 + 1.0);
            assert!((vertex.of(&points) - moved(place)).length() < tolerance, "{vertex:?}");
            assert!(vertex.weights.iter().all(|weight| *weight >= -1e-5), "{vertex:?}");
        }
    }
}

#[test]
fn broken_surfaces_are_mended_or_refused_with_a_sentence() {
    let whole = ball(1);
    let volume = |mesh: &Mesh| {
        let body = soft_body(mesh, &SoftMaterial { spacing: 0.2, ..MATERIAL }).expect("usable");
        (body.masses.iter().sum::<f64>(), body.warnings.join("\n"))
    };
    let (mass, _) = volume(&whole);

    let turned = |which: &dyn Fn(usize) -> bool| {
        let mut mesh = Mesh { positions: whole.positions.clone(), ..Mesh::default() };
        for (index, face) in whole.faces.iter().enumerate() {
            mesh.faces.push(&if which(index) {
                [face[0], face[2], face[1]]
            } else {
                [face[0], face[1], face[2]]
            });
        }
        mesh
    };
    let (inwards, said) = volume(&turned(&|_| true));
    assert!((inwards / mass - 1.0).abs() < 1e-12 && said.contains("turned inwards"), "{said}");
    let (mixed, said) = volume(&turned(&|index| index % 3 == 0));
    // Its volume is that of the rays now: right to second order in their distance, 0.05 of a radius.
    assert!(
        (mixed / mass - 1.0).abs() < 0.01 && said.contains("some faces are turned"),
        "{mixed} {mass} {said}"
    );

    let mut open = Mesh { positions: whole.positions.clone(), ..Mesh::default() };
    whole.faces.iter().skip(1).for_each(|face| open.faces.push(face));
    let error = soft_body(&open, &MATERIAL).expect_err("it has a hole");
    assert!(error.sentence().starts_with("is not closed: 3 edges have faces on one side only"), "{error}");
    let error = soft_body(&whole, &SoftMaterial { spacing: 1e-6, ..MATERIAL }).expect_err("too fine");
    assert_eq!(error.code(), Code::TooLarge);
}

#[test]
fn a_spacing_that_makes_too_many_springs_is_refused_before_they_are_made() {
    let mesh = ball(1);
    let material = SoftMaterial { spacing: 0.25, ..MATERIAL };
    let all = soft_body(&mesh, &material).expect("closed").springs.len() as u64;
    assert_eq!(soft_body_within(&mesh, &material, all).expect("just enough").springs.len() as u64, all);
    // One too few is found when springs are counted, far too few when cells are.
    for limit in [all - 1, 100] {
        let error = soft_body_within(&mesh, &material, limit).expect_err("too many");
        let exact = format!("spacing: is 0.25 m, and would fill the mesh with more than {limit} springs");
        assert!(error.to_string().starts_with(&exact), "{error}");
    }
    // Within the limit on cells: 200 across, and some 4 million inside with 9 springs each.
    let error = soft_body(&mesh, &SoftMaterial { spacing: 0.01, ..MATERIAL }).expect_err("too many");
    assert!(error.to_string().contains("more than 20000000 springs"), "{error}");
}
