//! Plain Rust: an array of springs, each of which adds its force to both of its ends. The twin of plain.cpp, with bounds
//! checked and no crate; the conversation stands at the head of measure.py.

use std::error::Error;
use std::io::Write;
use std::ops::{AddAssign, Mul, Sub, SubAssign};
use std::time::Instant;

#[derive(Clone, Copy, Default)]
struct Vec3(f32, f32, f32);

impl Vec3 {
    fn dot(self, b: Self) -> f32 {
        self.0 * b.0 + self.1 * b.1 + self.2 * b.2
    }
}

impl Sub for Vec3 {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Self(self.0 - b.0, self.1 - b.1, self.2 - b.2)
    }
}

impl Mul<f32> for Vec3 {
    type Output = Self;
    fn mul(self, s: f32) -> Self {
        Self(self.0 * s, self.1 * s, self.2 * s)
    }
}

impl AddAssign for Vec3 {
    fn add_assign(&mut self, b: Self) {
        *self = Self(self.0 + b.0, self.1 + b.1, self.2 + b.2);
    }
}

impl SubAssign for Vec3 {
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}

struct Spring {
    ends: [usize; 2],
    stiffness: f32,
    damping: f32,
    rest_length: f32,
}

/// The parts of the file, in its order.
struct File<'a>(&'a [u8]);

impl File<'_> {
    fn words(&mut self, count: usize) -> Result<Vec<[u8; 4]>, Box<dyn Error>> {
        let (words, rest) = self.0.split_at_checked(4 * count).ok_or("the network's file is too short")?;
        self.0 = rest;
        Ok(words.chunks_exact(4).map(|w| [w[0], w[1], w[2], w[3]]).collect())
    }

    fn floats(&mut self, count: usize) -> Result<Vec<f32>, Box<dyn Error>> {
        Ok(self.words(count)?.into_iter().map(f32::from_le_bytes).collect())
    }

    fn indices(&mut self, count: usize) -> Result<Vec<usize>, Box<dyn Error>> {
        Ok(self.words(count)?.into_iter().map(|word| u32::from_le_bytes(word) as usize).collect())
    }

    fn vectors(&mut self, count: usize) -> Result<Vec<Vec3>, Box<dyn Error>> {
        Ok(self.floats(3 * count)?.chunks_exact(3).map(|c| Vec3(c[0], c[1], c[2])).collect())
    }
}

struct Plain {
    dt: f32,
    gravity: Vec3,
    start: [Vec<Vec3>; 2],
    position: Vec<Vec3>,
    velocity: Vec<Vec3>,
    force: Vec<Vec3>,
    inverse_mass: Vec<f32>,
    springs: Vec<Spring>,
}

impl Plain {
    fn new(bytes: &[u8]) -> Result<Self, Box<dyn Error>> {
        let mut file = File(bytes.strip_prefix(b"network1").ok_or("the file holds no network")?);
        let counts = file.indices(2)?;
        let (points, springs) = (counts[0], counts[1]);
        let numbers = file.floats(2)?;
        let (position, velocity) = (file.vectors(points)?, file.vectors(points)?);
        let inverse_mass = file.floats(points)?;
        let ends = file.indices(2 * springs)?;
        let (stiffness, damping) = (file.floats(springs)?, file.floats(springs)?);
        let rest_length = file.floats(springs)?;
        let spring = |s: usize| Spring {
            ends: [ends[2 * s], ends[2 * s + 1]],
            stiffness: stiffness[s],
            damping: damping[s],
            rest_length: rest_length[s],
        };
        Ok(Self {
            dt: numbers[0],
            gravity: Vec3(0.0, numbers[1], 0.0),
            start: [position.clone(), velocity.clone()],
            position,
            velocity,
            force: vec![Vec3::default(); points],
            inverse_mass,
            springs: (0..springs).map(spring).collect(),
        })
    }

    fn reset(&mut self) {
        self.position.clone_from(&self.start[0]);
        self.velocity.clone_from(&self.start[1]);
    }

    fn step(&mut self) {
        for Spring { ends: [i, j], stiffness, damping, rest_length } in &self.springs {
            let axis = self.position[*i] - self.position[*j];
            let length = axis.dot(axis).sqrt();
            let u = axis * (1.0 / length);
            let speed = (self.velocity[*i] - self.velocity[*j]).dot(u);
            let pull = u * (stiffness * (length - rest_length) + damping * speed);
            self.force[*i] -= pull;
            self.force[*j] += pull;
        }
        for point in 0..self.position.len() {
            let w = self.inverse_mass[point];
            if w > 0.0 {
                self.velocity[point] += self.gravity * self.dt;
                self.velocity[point] += self.force[point] * (w * self.dt);
                self.position[point] += self.velocity[point] * self.dt;
            }
            self.force[point] = Vec3::default();
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("which network?")?;
    let bytes = std::fs::read(path)?;
    let begun = Instant::now();
    let mut plain = Plain::new(&bytes)?;
    plain.step();
    println!("{{\"setup_s\": {}}}", begun.elapsed().as_secs_f64());

    for line in std::io::stdin().lines() {
        match line?.split_whitespace().collect::<Vec<_>>()[..] {
            ["run", steps, times] => {
                let mut best = f64::INFINITY;
                for _ in 0..times.parse::<u32>()? {
                    plain.reset();
                    let begun = Instant::now();
                    (0..steps.parse::<u32>()?).for_each(|_| plain.step());
                    best = best.min(begun.elapsed().as_secs_f64());
                }
                println!("{{\"best_s\": {best}}}");
            }
            ["save", file] => {
                let mut file = std::io::BufWriter::new(std::fs::File::create(file)?);
                for Vec3(x, y, z) in &plain.position {
                    [x, y, z].into_iter().try_for_each(|&c| file.write_all(&f64::from(c).to_le_bytes()))?;
                }
                file.flush()?;
                println!("{{}}");
            }
            _ => return Err("commands are: run STEPS TIMES, save FILE".into()),
        }
    }
    Ok(())
}
