//! Bodies made from meshes: the same cloth and the same solid hang the same at any resolution; pins, masses, saving.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use sprung::build::Mesh;
use sprung::build::mesh::{Faces, MeshGroup};
use sprung::scene::Scene;
use sprung::{Change, Code, DVec3, ModelBuilder, Result, SettleOptions, Simulation, SurfaceKind, Vec3};

/// A square sheet from (0, 0, 0) to (1, −1, 0), `side` × `side` squares of two triangles each, the diagonals turned about in
/// the manner of a chequerboard. Its top row is the group "top".
fn sheet(side: u32) -> Mesh {
    let mut mesh = Mesh::default();
    let step = 1.0 / f64::from(side);
    for i in 0..=side {
        mesh.positions.extend((0..=side).map(|j| DVec3::new(f64::from(i), -f64::from(j), 0.0) * step));
    }
    for i in 0..side {
        for j in 0..side {
            let at = |a: u32, b: u32| (i + a) * (side + 1) + j + b;
            let [a, b, c, d] = [at(0, 0), at(0, 1), at(1, 1), at(1, 0)];
            let halves = if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[b, c, d], [b, d, a]] };
            halves.iter().for_each(|half| mesh.faces.push(half));
        }
    }
    let top = (0..=side).map(|i| i * (side + 1)).collect();
    mesh.groups.push(MeshGroup { name: "top".to_owned(), vertices: top });
    mesh
}

/// A beam from 0 to 4 along x and one by one across, of quads a unit wide: its mesh says nothing of the filling.
fn beam() -> Mesh {
    let mut mesh = Mesh::default();
    for x in 0..=4 {
        mesh.positions.extend(
            [(0, 0), (1, 0), (1, 1), (0, 1)]
                .map(|(y, z)| DVec3::new(f64::from(x), f64::from(y), f64::from(z))),
        );
    }
    mesh.faces.push(&[0, 3, 2, 1]);
    mesh.faces.push(&[16, 17, 18, 19]);
    for x in 0..4u32 {
        for side in 0..4u32 {
            let next = (side + 1) % 4;
            mesh.faces.push(&[4 * x + side, 4 * x + next, 4 * x + 4 + next, 4 * x + 4 + side]);
        }
    }
    mesh
}

fn loaded(text: &str, mesh: &Mesh) -> Result<Scene> {
    let mut scene = Scene::parse(text, "mesh.toml")?;
    scene.load_meshes(&mut |_| Ok(mesh.clone()))?;
    Ok(scene)
}

fn settled(scene: &Scene, residual_force: Option<f64>) -> Simulation {
    let mut simulation = scene.simulation().unwrap();
    simulation.settle(SettleOptions { residual_force, ..SettleOptions::default() }).unwrap();
    simulation
}

/// Where a vertex of the mesh is now: on a point, or carried by some.
fn vertex(simulation: &Simulation, index: usize) -> Vec3 {
    let positions = &simulation.state().position;
    match simulation.model().surfaces()[0].weighted() {
        [] => positions[index],
        weighted => weighted[index].of(positions),
    }
}

/// Hung by its upper border, a sheet stretches by ρ·g·L²/(2·E·h): 0.5·9.81/(2·50) = 0.04905 m at its lower border.
#[test]
fn a_sheet_hung_by_its_border_stretches_as_its_material_does() {
    let mut found = Vec::new();
    for side in [4, 8, 16] {
        let text = "
            [[body]]
            name = 'cloth'
            mesh = 'sheet.obj'
            pins = [{ group = 'top' }]
            cloth = { density = 0.5, stiffness = 50.0, damping = 0.02 }
        ";
        let simulation = settled(&loaded(text, &sheet(side)).unwrap(), None);
        let middle = (side / 2) * (side + 1) + side;
        found.push(-1.0 - f64::from(vertex(&simulation, middle as usize).y));
    }
    // The border that is held cannot become narrower as the rest does (Poisson's ratio 1/3): if nothing could, the sheet would be
    // stiffer by 1/(1 − 1/9) = 9/8. A finer mesh is the same cloth: lumped masses leave 1/side² of the stretch, and the
    // corners of the held border, where strains are uneven, about as much again.
    let last = found[2];
    assert!((0.04905 * 8.0 / 9.0..0.04905).contains(&last), "{found:?}");
    for (side, stretch) in [4.0, 8.0].into_iter().zip(&found) {
        assert!((stretch / last - 1.0).abs() < 2.0 / (side * side), "{found:?}");
    }
}

/// Held at its upper corners, it hangs in the same curve at three resolutions: places of the same vertices within 3 % of its side.
#[test]
fn a_sheet_hung_by_its_corners_hangs_the_same_at_three_resolutions() {
    let places: Vec<[Vec3; 2]> = [6u32, 12, 24]
        .into_iter()
        .map(|side| {
            let corner = side * (side + 1);
            let text = format!(
                "
            [[body]]
            name = 'cloth'
            mesh = 'sheet.obj'
            rotation = {{ axis = [1, 0, 0], degrees = 90 }}
            pins = [{{ nearest = [0, 0, 0] }}, {corner}]
            cloth = {{ density = 0.5, stiffness = 100.0, damping = 0.02 }}
        "
            );
            let simulation = settled(&loaded(&text, &sheet(side)).unwrap(), Some(1e-4));
            let at =
                |i: u32, j: u32| vertex(&simulation, ((i * side / 6) * (side + 1) + j * side / 6) as usize);
            // The middle, and the middle of the lower border. The upper border falls into folds, and those are as fine as triangles are.
            [at(3, 3), at(3, 6)]
        })
        .collect();
    // Stated, not derived: 0.013 and 0.011 of the side were found. The cloth takes up slack in folds, which are as fine as its
    // triangles, and so these differences shrink more slowly than those of a sheet without folds.
    for (coarse, tolerance) in [(0, 0.03), (1, 0.015)] {
        for (place, finest) in places[coarse].iter().zip(&places[2]) {
            assert!(place.distance(*finest) < tolerance, "{places:?}");
        }
    }
}

/// A beam held at one end sags by the same amount, however finely it is filled: to a share of 1/n² with n cells across.
#[test]
fn a_beam_of_three_fillings_sags_the_same() {
    let mesh = beam();
    let sags: Vec<f64> = [3.0, 4.0, 6.0]
        .into_iter()
        .map(|across: f64| {
            let text = format!(
                "
            [[body]]
            name = 'beam'
            mesh = 'beam.obj'
            pins = [{{ box = {{ min = [-0.01, -9, -9], max = [0.01, 9, 9] }} }}]
            soft = {{ spacing = {}, density = 100.0, stiffness = 2e6, damping = 0.002 }}
        ",
                1.0 / across
            );
            let scene = loaded(&text, &mesh).unwrap();
            let before = vertex(&scene.simulation().unwrap(), 16).y;
            let simulation = settled(&scene, Some(1.5));
            f64::from(before - vertex(&simulation, 16).y)
        })
        .collect();
    // Timoshenko: ρ·g·A·L⁴/(8·E·I) + ρ·g·A·L²/(2·κ·G·A) with G = 0.4·E and κ = 5/6 is 0.1884 + 0.0118 m. Springs along the beam
    // measure its bending at the borders of the cells and those across halfway between, which is too stiff by a share of
    // 1/n² (trapezoid 2/n² for two thirds of them, midpoint −1/n² for the rest); and the rest is for the held end, where the
    // section cannot become narrower, and for the sag itself, a twentieth of the length.
    let exact = 0.2002;
    for (across, sag) in [3.0f64, 4.0, 6.0].iter().zip(&sags) {
        let corrected = sag * (1.0 + 1.0 / (across * across));
        assert!((corrected / exact - 1.0).abs() < 0.06, "{sags:?}");
    }
}

#[test]
fn what_was_changed_is_saved_spring_by_spring() {
    let text = "
        [[body]]
        name = 'cloth'
        mesh = { file = 'sheet.obj', merge = 1e-5 }
        pins = [{ group = 'top' }]
        cloth = { density = 0.5, stiffness = 50.0, bending = 1e-6, damping = 0.01 }
        [[body.springs]]
        pairs = [[0, 24]]
        stiffness = 3.0
    ";
    let mesh = sheet(4);
    let scene = loaded(text, &mesh).unwrap();
    let mut simulation = scene.simulation().unwrap();
    simulation.change(Change::Stiffness(3..5, 12.0)).unwrap();
    simulation.change(Change::RestScale(7..9, 0.5)).unwrap();
    let mut params = simulation.params().clone();
    Arc::make_mut(&mut params.spring_cut)[11] = true;
    Arc::make_mut(&mut params.point_mass)[2] = 2.5;
    let saved = scene.with_params(simulation.model(), &params).unwrap();
    let cloth = saved.bodies[0].cloth.as_ref().unwrap();
    assert_eq!((cloth.except.len(), cloth.cut.len(), cloth.stiffness), (2, 1, 50.0));
    assert_eq!(cloth.density, None, "the masses of the points are said instead");
    let again = loaded(&saved.to_toml(), &mesh).unwrap();
    assert_eq!(again, saved);
    let (model, found, _) = again.build().unwrap();
    assert_eq!((&model, &found), (simulation.model().as_ref(), &params));
}

#[test]
fn a_changed_scene_keeps_its_mesh_and_is_made_anew() {
    let text = "
        [[body]]
        name = 'cloth'
        mesh = 'sheet.obj'
        cloth = { density = 0.5, stiffness = 50.0 }
    ";
    let mut scene = loaded(text, &sheet(4)).unwrap();
    scene.set("body.cloth.scale", "2").unwrap();
    let (_, params, state) = scene.build().unwrap();
    let mass: f32 = params.point_mass.iter().sum();
    assert!((mass - 2.0).abs() < 1e-5 && state.position.iter().any(|p| p.y == -2.0), "{mass}");
    scene.bodies[0].cloth.as_mut().unwrap().density = None;
    scene.bodies[0].body_mass = Some(3.0);
    let mass: f32 = scene.build().unwrap().1.point_mass.iter().sum();
    assert!((mass - 3.0).abs() < 1e-5, "{mass}");
    // Another file has to be read.
    scene.set("body.cloth.mesh", "\"other.obj\"").unwrap();
    assert!(scene.waits_for_meshes());
    let error = scene.build().unwrap_err();
    let exact = "--set body.cloth.mesh=\"other.obj\": body[0].mesh: is \"other.obj\", which has not been read; open the scene's file, so that its folder is known";
    assert_eq!(error.to_string(), exact);
}

#[test]
fn a_material_is_set_by_its_own_key_and_never_as_if_it_were_a_spring() {
    let mesh = sheet(2);
    let body =
        |name: &str, material: &str| format!("[[body]]\nname = \"{name}\"\nmesh = \"m\"\n{material}\n");
    let towel = body("towel", "cloth = { density = 0.4, stiffness = 150, damping = 0.02 }");
    let line = "[[body]]\nname = \"line\"\npoints = [[0, 0, 0], [1, 0, 0]]\n\
                springs = [{ pairs = [[0, 1]], stiffness = 7 }]\n";
    let text = format!("{towel}{}{line}", body("veil", "net = { stiffness = 10 }"));
    let mut scene = loaded(&text, &mesh).unwrap();

    let before = scene.build().unwrap().1.spring_stiffness.clone();
    scene.set("body.towel.cloth.stiffness", "300").unwrap();
    scene.set("body.0.cloth.damping", "0.1").unwrap();
    scene.set("body.veil.net.damping", "0.5").unwrap();
    let cloth = scene.bodies[0].cloth.clone().unwrap();
    assert_eq!((cloth.stiffness, cloth.damping), (300.0, 0.1));
    let after = scene.build().unwrap().1.spring_stiffness.clone();
    assert_eq!(after[0], 2.0 * before[0], "the springs follow from the material");

    // A net's springs are springs; bodies that are no cloth are passed over.
    scene.set("body.veil.stiffness", "20").unwrap();
    scene.set("body.cloth.stiffness", "200").unwrap();
    let net = scene.bodies[1].net.clone().unwrap();
    assert_eq!((net.stiffness, net.damping, net.rest_scale), (20.0, 0.5, 1.0));
    assert_eq!(scene.bodies[0].cloth.as_ref().unwrap().stiffness, 200.0);
    scene.set("rest_scale", "0.9").unwrap();
    assert_eq!(scene.bodies[0].cloth.as_ref().unwrap().rest_scale, 0.9);
    assert_eq!(scene.bodies[1].net.as_ref().unwrap().rest_scale, 0.9);

    for key in ["stiffness", "damping", "body.stiffness", "body.towel.damping", "body.0.stiffness"] {
        let error = scene.set(key, "500").unwrap_err().to_string();
        let short = key.rsplit('.').next().unwrap();
        assert!(error.contains("\"towel\" is cloth, a material"), "{error}");
        assert!(error.contains(&format!("write body.towel.cloth.{short} for it")), "{error}");
    }
    let error = scene.set("body.veil.cloth.stiffness", "1").unwrap_err().to_string();
    assert!(error.contains("has no cloth"), "{error}");

    // A body may be called what a material is called.
    let mut scene = loaded(&line.replace("line", "cloth"), &mesh).unwrap();
    scene.set("body.cloth.stiffness", "8").unwrap();
    assert_eq!(scene.bodies[0].springs[0].stiffness, 8.0);
}

#[test]
fn a_density_besides_masses_is_refused() {
    for material in
        ["cloth = { density = 0.4, stiffness = 150 }", "soft = { density = 900, spacing = 1, stiffness = 5 }"]
    {
        for mass in ["point_mass", "body_mass"] {
            let text = format!("[[body]]\nname = \"towel\"\nmesh = \"m\"\n{mass} = 2\n{material}\n");
            let error = Scene::parse(&text, "mesh.toml").unwrap_err().to_string();
            let exact = format!("density: is said besides the body's {mass}; one of them is enough");
            assert!(error.contains(&exact), "{error}");
        }
    }
    let text = "[[body]]\nname = \"towel\"\nmesh = \"m\"\npoint_mass = 2\ncloth = { stiffness = 150 }\n";
    let (_, params, _) = loaded(text, &sheet(2)).unwrap().build().unwrap();
    assert!(params.point_mass.iter().all(|&mass| mass == 2.0));
}

#[test]
fn triangles_make_faces_only_as_fans() {
    let mut faces = Faces::default();
    [&[0, 1, 4][..], &[1, 2, 3, 4], &[4, 3, 5, 6, 0]].into_iter().for_each(|face| faces.push(face));
    assert_eq!(faces.fans(), [1, 2, 3]);
    let joined = |triangles: &[[u32; 3]], fans: &[u32]| {
        let mut builder = ModelBuilder::new();
        for x in 0..7u8 {
            builder.add_point(Vec3::X * f32::from(x), 1.0).unwrap();
        }
        builder.add_surface(SurfaceKind::Cloth, triangles.to_vec()).unwrap();
        builder.join_into_faces(fans.to_vec())?;
        let (model, ..) = builder.build()?;
        assert_eq!(model.surfaces()[0].fans, fans);
        Ok(())
    };
    let triangles = faces.triangles();
    for fans in [&[1, 2, 3][..], &[1; 6], &[]] {
        joined(&triangles, fans).unwrap();
    }
    // Too few, too many, none at all, and triangles that do not follow each other around a corner.
    for fans in [&[1, 2][..], &[1, 2, 3, 1], &[1, 2, 4], &[0, 1, 2, 3], &[2, 1, 3], &[1, 3, 2], &[u32::MAX]] {
        let error: sprung::Error = joined(&triangles, fans).unwrap_err();
        assert_eq!(error.code(), Code::Conflict, "{fans:?}: {error}");
    }
    assert!(ModelBuilder::new().join_into_faces(vec![1]).is_err());
}
