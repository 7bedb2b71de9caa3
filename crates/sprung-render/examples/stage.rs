//! Draws built-in scenes on the graphics card and measures it: `cargo run --release --features gpu --example stage`.
//! With a folder as its argument it also stores the pictures.
#![allow(clippy::print_stdout, reason = "an example for people")]

#[cfg(feature = "gpu")]
fn main() -> sprung::Result<()> {
    measure::all(std::env::args().nth(1).as_deref())
}

#[cfg(not(feature = "gpu"))]
fn main() {
    println!("this example needs --features gpu");
}

#[cfg(feature = "gpu")]
mod measure {
    use std::path::Path;
    use std::time::Instant;

    use glam::Vec2;
    use sprung::scene::Scene;
    use sprung::{Simulation, Vec3};
    use sprung_render::appearance::Appearance;
    use sprung_render::camera::Bounds;
    use sprung_render::gpu::{Marks, Moment, Stage, Timings, headless};
    use sprung_render::turntable::Turntable;

    const SIZE: [u32; 2] = [1280, 720];
    const FRAMES: usize = 6;

    pub fn all(folder: Option<&str>) -> sprung::Result<()> {
        let headless = headless()?;
        println!("{} ({:?})", headless.info.name, headless.info.backend);
        println!(
            "draw: what the card does, without shadows and planes, and with them; the least of {FRAMES}"
        );
        let [scene, points, springs] = ["scene", "points", "springs"];
        let [upload, encode, plain, full] = ["upload ms", "encode ms", "plain ms", "draw ms"];
        println!("{scene:>10} {points:>9} {springs:>9} {upload:>10} {encode:>10} {plain:>9} {full:>9}");
        for name in ["jelly", "cloth512", "jelly64"] {
            let (model, params, state) = Scene::builtin(name)?.build()?;
            let mut simulation = Simulation::new(model, params, state)?;
            let mut stage = Stage::new(&headless.device, &headless.queue);
            stage.set_model(simulation.model());
            stage.set_params(simulation.params());
            simulation.frame()?;
            let (model, params) = (simulation.model().clone(), simulation.params().clone());
            let positions: Vec<Vec3> = simulation.snapshot().positions.clone();
            let mut bounds = Bounds::default();
            positions.iter().for_each(|place| bounds.include(*place));
            let size = Vec2::new(SIZE[0] as f32, SIZE[1] as f32);
            let camera = Turntable::framing(&bounds, size.x / size.y).camera(size);
            let mut look = Appearance::default();
            look.full_scale = Appearance::full_scale_for(&model, &params, &positions, look.colour_by);
            let moment = Moment { before: &positions, now: &positions, blend: 0.5, ..Default::default() };
            let mut best = [[f64::MAX; 3]; 2];
            // With shadows and planes, and without; the first drawing makes lists and textures.
            for (best, is_full) in best.iter_mut().zip([false, true]) {
                (look.shadows, look.ground) = (is_full, is_full);
                for _ in 0..=FRAMES {
                    let begin = Instant::now();
                    stage.draw(&moment, &Marks::default(), &camera, &look, SIZE);
                    let Timings { upload, encode } = stage.timings();
                    let _ = headless.device.poll(wgpu::PollType::wait_indefinitely());
                    let card = begin.elapsed().as_secs_f64() - upload - encode;
                    *best = [best[0].min(upload), best[1].min(encode), best[2].min(card)];
                }
            }
            let [[_, _, plain], [upload, encode, full]] = best.map(|times| times.map(|time| 1e3 * time));
            let (points, springs) = (model.point_count(), model.spring_count());
            println!(
                "{name:>10} {points:>9} {springs:>9} {upload:>10.2} {encode:>10.2} {plain:>9.1} {full:>9.1}"
            );
            if let Some(folder) = folder {
                let image = stage.read();
                let path = Path::new(folder).join(format!("{name}.png"));
                let write = |file| sprung_render::export::write_png(file, &image);
                if let Err(error) = std::fs::File::create(&path).and_then(write) {
                    println!("{}: {error}", path.display());
                }
            }
        }
        Ok(())
    }
}
