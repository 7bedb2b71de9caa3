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
    use sprung_render::gpu::{Headless, Marks, Moment, Quality, Stage, Timings, headless};
    use sprung_render::turntable::Turntable;

    const SIZE: [u32; 2] = [1280, 720];
    const FRAMES: usize = 12;

    pub fn all(folder: Option<&str>) -> sprung::Result<()> {
        let headless = headless()?;
        println!("{} ({:?})", headless.info.name, headless.info.backend);
        println!(
            "milliseconds at {} x {}, the least of {FRAMES}; draw: what the card does;",
            SIZE[0], SIZE[1]
        );
        println!("processor: the mean time of all threads, where the system tells it");
        let [scene, quality, upload, encode] = ["scene", "quality", "upload", "encode"];
        println!("{scene:>10} {quality:>9} {upload:>8} {encode:>8} {:>8} {:>10}", "draw", "processor");
        for name in ["jelly", "cloth512", "jelly64"] {
            for quality in Quality::ALL {
                scene_in(&headless, name, quality, folder)?;
            }
        }
        Ok(())
    }

    fn scene_in(
        headless: &Headless,
        name: &str,
        quality: Quality,
        folder: Option<&str>,
    ) -> sprung::Result<()> {
        let (model, params, state) = Scene::builtin(name)?.build()?;
        let mut simulation = Simulation::new(model, params, state)?;
        let mut stage = Stage::new(&headless.device, &headless.queue, quality);
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

        let mut best = [f64::MAX; 3];
        let mut spent = None;
        // The first drawing makes lists, textures and the driver's own code.
        for frame in 0..=FRAMES {
            if frame == 1 {
                spent = processor();
            }
            let begin = Instant::now();
            stage.draw(&moment, &Marks::default(), &camera, &look, SIZE);
            let Timings { upload, encode } = stage.timings();
            let _ = headless.device.poll(wgpu::PollType::wait_indefinitely());
            let card = begin.elapsed().as_secs_f64() - upload - encode;
            let times = [upload, encode, card];
            best = if frame == 0 { best } else { [0, 1, 2].map(|part| times[part].min(best[part])) };
        }
        let spent = spent.zip(processor()).map(|(before, after)| (after - before) / FRAMES as f64);
        let spent = spent.map_or("-".to_owned(), |seconds| format!("{:.0}", 1e3 * seconds));
        let [upload, encode, card] = best.map(|time| 1e3 * time);
        let quality = format!("{quality:?}").to_lowercase();
        println!("{name:>10} {quality:>9} {upload:>8.2} {encode:>8.2} {card:>8.1} {spent:>10}");

        if let Some(folder) = folder {
            let image = stage.read();
            let path = Path::new(folder).join(format!("{name}-{quality}.png"));
            let write = |file| sprung_render::export::write_png(file, &image);
            if let Err(error) = std::fs::File::create(&path).and_then(write) {
                println!("{}: {error}", path.display());
            }
        }
        Ok(())
    }

    /// Processor time of this process so far, s: its 14th and 15th number in Linux's list, in hundredths.
    fn processor() -> Option<f64> {
        let text = std::fs::read_to_string("/proc/self/stat").ok()?;
        let (_, after_name) = text.rsplit_once(')')?;
        let ticks = after_name.split_whitespace().skip(11).take(2).map(|word| word.parse::<f64>().ok());
        Some(ticks.sum::<Option<f64>>()? / 100.0)
    }
}
