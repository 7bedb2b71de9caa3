//! The naive twin: the method of docs/method.md in float64, with the report's own loops. It shares no code with the engine.

/// A vector, written out.
pub type V3 = [f64; 3];

pub fn add(a: V3, b: V3) -> V3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn sub(a: V3, b: V3) -> V3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub fn scale(a: V3, s: f64) -> V3 {
    [a[0] * s, a[1] * s, a[2] * s]
}

pub fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn norm(a: V3) -> f64 {
    dot(a, a).sqrt()
}

/// A point: mass m (zero: fixed in space), position x, velocity v, force accumulator f.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    pub m: f64,
    pub x: V3,
    pub v: V3,
    pub f: V3,
}

/// A spring between points i < j: stiffness k_s, damping k_d, rest length L.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    pub i: usize,
    pub j: usize,
    pub ks: f64,
    pub kd: f64,
    pub rest: f64,
}

/// A ground plane at height `y` with the report's contact law.
#[derive(Clone, Debug, PartialEq)]
pub struct Ground {
    pub y: f64,
    pub kc: f64,
    pub kcd: f64,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Twin {
    pub points: Vec<Point>,
    pub springs: Vec<Spring>,
    pub ground: Option<Ground>,
    pub g: f64,
}

impl Twin {
    pub fn add_point(&mut self, m: f64, x: V3, v: V3) {
        self.points.push(Point { m, x, v, f: [0.0; 3] });
    }

    /// The report's `createSprings`: every pair no further apart than `l_max`, at rest.
    pub fn create_springs(&mut self, l_max: f64, ks: f64, kd: f64) {
        for i in 0..self.points.len() {
            for j in i + 1..self.points.len() {
                let rest = norm(sub(self.points[i].x, self.points[j].x));
                if rest <= l_max {
                    self.springs.push(Spring { i, j, ks, kd, rest });
                }
            }
        }
    }

    /// One step of length dt.
    pub fn step(&mut self, dt: f64) {
        // 1. Springs and their dampers.
        for spring in &self.springs {
            let (a, b) = (&self.points[spring.i], &self.points[spring.j]);
            let e = sub(a.x, b.x);
            let l = norm(e);
            if l == 0.0 {
                continue; // no axis
            }
            let u = scale(e, 1.0 / l);
            let fs = scale(u, -spring.ks * (l - spring.rest));
            let fd = scale(u, -spring.kd * dot(sub(a.v, b.v), u));
            let f = add(fs, fd);
            self.points[spring.i].f = add(self.points[spring.i].f, f);
            self.points[spring.j].f = sub(self.points[spring.j].f, f);
        }
        // 2. Gravity and the ground.
        for p in &mut self.points {
            p.f[1] -= p.m * self.g;
            if let Some(ground) = &self.ground {
                let depth = ground.y - p.x[1];
                if depth > 0.0 {
                    p.f[1] += ground.kc * depth - ground.kcd * p.v[1];
                }
            }
        }
        // 3. The new velocity, then the new position with it.
        for p in &mut self.points {
            if p.m > 0.0 {
                p.v = add(p.v, scale(p.f, dt / p.m));
                p.x = add(p.x, scale(p.v, dt));
            }
            p.f = [0.0; 3];
        }
    }
}
