//! Patch tests: uniformly strained, springs hold the energy of the material that they are made from.

use super::*;

const MATERIAL: ClothMaterial = ClothMaterial {
    density: 0.3,
    stiffness: 40.0,
    bending: 0.0,
    bending_radius: None,
    damping: 0.01,
    merge: None,
};

/// Pseudo-random numbers from 0 to 1 (xorshift, Marsaglia 2003).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A unit square of irregular triangles: a grid with its inner points moved about and diagonals drawn at random.
fn irregular(side: u32, seed: u64) -> Mesh {
    let mut random = Random(seed);
    let mut mesh = Mesh::default();
    for i in 0..=side {
        for j in 0..=side {
            let mut moved = |k: u32| if k == 0 || k == side { 0.0 } else { 0.5 * (random.next() - 0.5) };
            let (x, z) = (f64::from(i) + moved(i), f64::from(j) + moved(j));
            mesh.positions.push(DVec3::new(x, 0.0, z) / f64::from(side));
        }
    }
    for i in 0..side {
        for j in 0..side {
            let at = |a: u32, b: u32| (i + a) * (side + 1) + j + b;
            let [a, b, c, d] = [at(0, 0), at(0, 1), at(1, 1), at(1, 0)];
            let halves = if random.next() < 0.5 { [[a, b, c], [a, c, d]] } else { [[b, c, d], [b, d, a]] };
            halves.iter().for_each(|half| mesh.faces.push(half));
        }
    }
    mesh
}

/// A strain in the plane of the sheet: along x, along z, and half the shear angle.
type Strain = [f64; 3];

fn along(strain: Strain, n: DVec3) -> f64 {
    strain[0] * n.x * n.x + strain[1] * n.z * n.z + 2.0 * strain[2] * n.x * n.z
}

/// Second-order energy of all springs under a small uniform strain: ½·k·(ℓ·nᵀεn)².
fn energy(body: &MeshBody, strain: Strain) -> f64 {
    let of = |spring: &super::super::MeshSpring| {
        let [a, b] = spring.ends.map(|point| body.points[point as usize]);
        let (length, n) = ((b - a).length(), (b - a).normalize());
        let stretch = length * along(strain, n);
        0.5 * spring.stiffness * stretch * stretch
    };
    body.springs.iter().map(of).sum()
}

/// The isotropic membrane with Poisson's ratio 1/3: ½(λ·tr(ε)² + 2μ·tr(ε²)) with λ = μ = 3/8·E·h, for a unit square.
fn material_energy([xx, zz, xz]: Strain) -> f64 {
    let (trace, squared) = (xx + zz, xx * xx + zz * zz + 2.0 * xz * xz);
    0.5 * 0.375 * MATERIAL.stiffness * (trace * trace + 2.0 * squared)
}

/// The share of a sheet's area in triangles that are in no pair.
fn left_over(mesh: &Mesh) -> f64 {
    let points: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    let Patches { patches, .. } = Patches::new(mesh, &points, &mesh.positions);
    let area = |only: bool| -> f64 {
        patches.iter().filter(|patch| !only || patch.segments.len() == 3).map(|patch| patch.area).sum()
    };
    area(true) / area(false)
}

#[test]
fn irregular_triangles_hold_the_energy_of_the_material() {
    let strains: [Strain; 4] = [[1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for (side, seed) in [(6, 1), (12, 2), (24, 3)] {
        let mesh = irregular(side, seed);
        let body = cloth(&mesh, &MATERIAL).expect("sound");
        for strain in strains {
            let ratio = energy(&body, strain) / material_energy(strain);
            // Uniform stretching is exact in triangles of any shape, and another strain in the pairs that make a quad. In those left
            // over, a tenth of the sheet, sides point where they happen to. If each had two along the axes and the third halfway, it
            // would hold 10/9 of the energy of a stretch along one of these, and 2/3 of that of a shear: off by a third of the share
            // that is left over. So it is in the mean (0.30, 0.25 and 0.23 of the share in shear, of 32 sheets each), and these three
            // sheets are within it, by 0.15, 0.27 and 0.22. No bound for all: where corners are moved so far, some sheets were
            // off by twice as much, up to 0.04, 0.03 and 0.03 of the whole.
            let bound =
                if strain[0] == strain[1] && strain[2] == 0.0 { 1e-12 } else { left_over(&mesh) / 3.0 };
            assert!((ratio - 1.0).abs() <= bound, "{side} {strain:?}: {ratio}");
        }
    }
}

/// A unit square of quads, its inner points moved along each axis by up to `shift` sides of a quad.
fn quads(side: u32, shift: f64, seed: u64) -> Mesh {
    let mut random = Random(seed);
    let mut mesh = Mesh::default();
    for i in 0..=side {
        for j in 0..=side {
            let mut moved =
                |k: u32| if k == 0 || k == side { 0.0 } else { 2.0 * shift * (random.next() - 0.5) };
            let (x, z) = (f64::from(i) + moved(i), f64::from(j) + moved(j));
            mesh.positions.push(DVec3::new(x, 0.0, z) / f64::from(side));
        }
    }
    for i in 0..side {
        for j in 0..side {
            let at = |a: u32, b: u32| (i + a) * (side + 1) + j + b;
            mesh.faces.push(&[at(0, 0), at(0, 1), at(1, 1), at(1, 0)]);
        }
    }
    mesh
}

/// Quads that are no squares: the isotropic membrane, whatever the strain, but for a share of the second order.
#[test]
fn irregular_quads_are_isotropic() {
    let strains = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.3, -0.8, 0.4]];
    let error = |shift: f64| {
        let mut squares = 0.0;
        for seed in 1..=20 {
            let body = cloth(&quads(28, shift, seed * 0x9E37_79B9), &MATERIAL).expect("sound");
            // Uniform stretching is exact.
            assert!((energy(&body, [1.0, 1.0, 0.0]) / material_energy([1.0, 1.0, 0.0]) - 1.0).abs() < 1e-12);
            for strain in strains {
                let off = energy(&body, strain) / material_energy(strain) - 1.0;
                squares += off * off / (20.0 * strains.len() as f64);
            }
        }
        squares.sqrt()
    };
    // In a patch that is nearly a square the equation of sin4θ nearly says nothing: moved by δ sides, corners change what it asks
    // for by δ² (the terms of first order cancel) and what springs can do for it by δ. Where that would take springs that push,
    // it is met in part, and so something of the second order is missing. Of sheets with δ = 0.1, 0.05 and 0.025 it is, root mean
    // square, 0.32, 0.35 and 0.45 δ²; the half is stated, the order is what follows.
    for shift in [0.1, 0.05, 0.025] {
        let off = error(shift);
        assert!(off < 0.5 * shift * shift, "{shift}: {off}");
    }
    // One small sheet, whose few patches do not average out: at worst of twenty 1.4 δ² were found, and of this one this is.
    let body = cloth(&quads(7, 0.1, 11), &MATERIAL).expect("sound");
    for strain in strains {
        let ratio = energy(&body, strain) / material_energy(strain);
        assert!((ratio - 1.0).abs() < 0.01, "{strain:?}: {ratio}");
    }
}

/// A sheet of equilateral triangles is the isotropic membrane, but for its border.
#[test]
fn equilateral_triangles_are_isotropic() {
    let mut mesh = Mesh::default();
    let height = 0.75f64.sqrt();
    mesh.positions = (0..6)
        .map(|k| {
            let angle = f64::from(k) * std::f64::consts::FRAC_PI_3;
            DVec3::new(angle.cos(), 0.0, angle.sin())
        })
        .chain([DVec3::ZERO])
        .collect();
    (0..6).for_each(|k| mesh.faces.push(&[k, (k + 1) % 6, 6]));
    let body = cloth(&mesh, &MATERIAL).expect("sound");
    let area = 3.0 * height;
    for strain in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.3, -0.2, 0.7]] {
        let ratio = energy(&body, strain) / (area * material_energy(strain));
        assert!((ratio - 1.0).abs() < 1e-12, "{strain:?}: {ratio}");
    }
    let mass: f64 = body.masses.iter().sum();
    assert!((mass - 0.3 * area).abs() < 1e-12);
}

/// A square's sides have 3/8 of its stiffness and its diagonals, √2 long, as much; and so has a pair of triangles.
#[test]
fn squares_favour_no_direction() {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 0.0, 1.0), DVec3::Z];
    let mut quad = Mesh { positions, ..Mesh::default() };
    let mut pair = quad.clone();
    quad.faces.push(&[1, 2, 3, 0]);
    [[0, 1, 2], [0, 2, 3]].iter().for_each(|half| pair.faces.push(half));
    for mesh in [quad, pair] {
        let body = cloth(&mesh, &MATERIAL).expect("sound");
        assert_eq!(body.springs.len(), 6);
        assert!(body.springs.iter().all(|spring| (spring.stiffness - 15.0).abs() < 1e-12), "{body:?}");
        assert!((body.masses.iter().sum::<f64>() - 0.3).abs() < 1e-15);
    }
}

/// Bending springs take their stretching from the edges: uniformly stretched, the sheet is what it was.
#[test]
fn bending_leaves_stretching_as_it_was() {
    let mesh = irregular(10, 7);
    let stiff = ClothMaterial { bending: 1e-7, bending_radius: Some(0.2), ..MATERIAL };
    let [plain, stiff] = [MATERIAL, stiff].map(|material| cloth(&mesh, &material).expect("sound"));
    assert!(stiff.springs.len() > plain.springs.len() + 100);
    let [before, after] = [&plain, &stiff].map(|body| energy(body, [1.0, 1.0, 0.0]));
    assert!((after / before - 1.0).abs() < 1e-12, "{before} {after}");
}

/// Rolled to the radius that was asked for, a sheet of squares or of equilateral triangles holds the plate's energy ½·B·A/R²,
/// finely or coarsely divided.
#[test]
fn a_rolled_sheet_holds_the_energy_of_a_plate() {
    let (bending, radius) = (1e-6, 0.4);
    for side in [8u32, 16] {
        let step = 1.0 / f64::from(side);
        let mut mesh = Mesh::default();
        for i in 0..=side {
            mesh.positions.extend((0..=side).map(|j| DVec3::new(f64::from(i), 0.0, f64::from(j)) * step));
        }
        for i in 0..side {
            for j in 0..side {
                let at = |a: u32, b: u32| (i + a) * (side + 1) + j + b;
                [[at(0, 0), at(0, 1), at(1, 1)], [at(0, 0), at(1, 1), at(1, 0)]]
                    .iter()
                    .for_each(|t| mesh.faces.push(t));
            }
        }
        let bent = ClothMaterial { stiffness: 1e4, bending, bending_radius: Some(radius), ..MATERIAL };
        let body = cloth(&mesh, &bent).expect("sound");
        assert_eq!(body.warnings, [""; 0]);
        // Rolled about z so that rows keep their distance: chords of length `step`.
        let turn = 2.0 * (0.5 * step / radius).asin();
        let rolled = |p: DVec3| {
            let angle = turn * (p.x / step).round();
            DVec3::new(radius * angle.sin(), radius * (1.0 - angle.cos()), p.z)
        };
        let mut energy = 0.0;
        for spring in &body.springs {
            let [a, b] = spring.ends.map(|point| body.points[point as usize]);
            let stretch = (rolled(b) - rolled(a)).length() - (b - a).length();
            energy += 0.5 * spring.stiffness * stretch * stretch;
        }
        // Of `side` rows of hinges the outermost half steps have none: area (1 − step). The hinge angle is `step`/R to third
        // order, and so is the energy to second: (step/R)²/4 of it at most.
        let exact = 0.5 * bending * (1.0 - step) / (radius * radius);
        let slack = 0.25 * (step / radius) * (step / radius) + 1e-6;
        assert!((energy / exact - 1.0).abs() < slack, "{side}: {energy} {exact}");
    }
}

#[test]
fn broken_meshes_are_used_with_a_sentence() {
    let mut mesh = irregular(3, 5);
    mesh.positions.push(DVec3::new(5.0, 5.0, 5.0));
    mesh.faces.push(&[0, 1, 1]);
    let spare = mesh.positions.len() as u32;
    mesh.positions.push(DVec3::new(0.5, 0.7, 0.5));
    mesh.faces.push(&[5, 6, spare]);
    let body = cloth(&mesh, &MATERIAL).expect("usable");
    let said = body.warnings.join("\n");
    for part in ["1 triangle has no area", "1 vertex has no cloth around", "1 edge has more than two faces"] {
        assert!(said.contains(part), "{said}");
    }
    mesh.positions[0].x = f64::NAN;
    assert_eq!(cloth(&mesh, &MATERIAL).expect_err("it is broken").code(), Code::OutOfRange);
}

/// Faces around one edge, like the pages of a book.
fn book(pages: u32) -> Mesh {
    let mut mesh = Mesh { positions: vec![DVec3::ZERO, DVec3::Y], ..Mesh::default() };
    for page in 0..pages {
        let angle = f64::from(page) / f64::from(pages) * std::f64::consts::TAU;
        mesh.positions.push(DVec3::new(angle.cos(), 0.5, angle.sin()));
        mesh.faces.push(&[0, 1, page + 2]);
    }
    mesh
}

#[test]
fn an_edge_that_very_many_faces_share_has_no_springs_across() {
    let bent = ClothMaterial { bending: 1e-7, ..MATERIAL };
    // The edge and two sides for each page; and each pair of pages, as long as there are few.
    let few = cloth(&book(16), &bent).expect("sound");
    assert_eq!(few.springs.len(), 1 + 2 * 16 + 16 * 15 / 2);
    assert_eq!(few.warnings[0], "1 edge has more than two faces");
    let many = cloth(&book(20_000), &bent).expect("sound");
    assert_eq!(many.springs.len(), 1 + 2 * 20_000);
    let exact = "1 edge has more than two faces, and 1 has more than 16: there the cloth folds freely";
    assert_eq!(many.warnings, [exact]);
}

/// A polygon that goes round the same three corners is as many triangles in one place: a lot of faces at each edge, and no more.
#[test]
fn a_polygon_that_repeats_its_corners_takes_no_longer_than_it_is() {
    let mut mesh = Mesh { positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y], ..Mesh::default() };
    mesh.faces.push(&[0, 1, 2].repeat(300_000));
    for bending in [0.0, 1e-7] {
        let body = cloth(&mesh, &ClothMaterial { bending, ..MATERIAL }).expect("usable");
        assert_eq!(body.springs.len(), 3);
        assert!(body.warnings.iter().any(|said| said.starts_with("3 edges have more than two faces")));
    }
}
