//! What it costs to send reports to a page: bytes, and milliseconds at both ends.
//!
//! `cargo run --release -p sprung-driver --example wire_cost [SCENE…]`

// Printing is what this program is for.
#![allow(clippy::print_stdout)]

use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

use sprung::Result;
use sprung::scene::Scene;
use sprung_driver::{Command, Handle, Host, Options, Source, Word};

/// How long each plays.
const PLAYED: Duration = Duration::from_secs(4);
/// From one picture of the page to the next.
const FRAME: Duration = Duration::from_micros(16_667);

fn main() -> Result<()> {
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let names =
        if asked.is_empty() { ["jelly", "cloth512", "jelly64"].map(String::from).into() } else { asked };
    names.iter().try_for_each(|name| play(name))
}

fn play(name: &str) -> Result<()> {
    let source = Source { name: name.to_owned(), scene: Scene::builtin(name)? };
    let ((messages, to_host), (to_page, words)) = (channel(), channel());
    let post = Box::new(move |message| _ = messages.send(message));
    let begun = Instant::now();
    let mut page = Handle::remote(source.clone(), Options::default(), post, words)?;
    let opened_here = begun.elapsed();
    let begun = Instant::now();
    let mut host = Host::new(&to_host.recv().unwrap_or_default())?;
    let opened_there = begun.elapsed();
    let ms = |time: Duration| 1e3 * time.as_secs_f64();
    println!("{name}: {:.0} ms to open at the page, {:.0} ms at the host", ms(opened_here), ms(opened_there));

    page.send(Command::Play(true));
    let (begun, mut frame) = (Instant::now(), Instant::now());
    let (mut bytes, mut writing, mut reading) = (Vec::new(), Vec::new(), Vec::new());
    while begun.elapsed() < PLAYED {
        to_host.try_iter().for_each(|message| host.hear(&message));
        let rest = host.turn();
        let asked = Instant::now();
        while let Some(message) = host.report() {
            bytes.push(message.len());
            let _ = to_page.send(Word::Message(message));
        }
        writing.push(asked.elapsed());
        std::thread::sleep(rest.unwrap_or_default());
        if frame.elapsed() >= FRAME {
            frame = Instant::now();
            let step = page.report().now.step;
            reading.push(frame.elapsed());
            assert!(step < u64::MAX);
        }
    }
    let report = page.report();
    let seconds = begun.elapsed().as_secs_f64();
    let (all, reports) = (bytes.iter().sum::<usize>() as f64, bytes.len() as f64);
    bytes.sort_unstable();
    println!(
        "  {:.0} steps/s, {:.0} reports/s of {:.0} bytes (median {}): {:.1} MB/s",
        report.now.step as f64 / seconds,
        reports / seconds,
        all / reports,
        bytes[bytes.len() / 2],
        all / seconds / 1e6
    );
    for (what, times) in [("writing", writing), ("reading", reading)] {
        let sum: Duration = times.iter().sum();
        let longest = times.iter().max().copied().unwrap_or_default();
        println!(
            "  {what}: {:.2} ms for each report, {:.2} ms at the longest",
            ms(sum) / reports,
            ms(longest)
        );
    }
    let begun = Instant::now();
    page.send(Command::Open(Box::new(source)));
    let serial = report.opened.serial + 1;
    let mut most = Duration::ZERO;
    let mut largest = 0;
    while page.report().opened.serial < serial {
        to_host.try_iter().for_each(|message| host.hear(&message));
        host.turn();
        while let Some(message) = host.report() {
            largest = largest.max(message.len());
            let _ = to_page.send(Word::Message(message));
        }
        let asked = Instant::now();
        page.report();
        most = most.max(asked.elapsed());
    }
    println!(
        "  opening it again: {:.0} ms, {:.0} ms of it at the page, {:.1} MB",
        ms(begun.elapsed()),
        ms(most),
        largest as f64 / 1e6
    );
    Ok(())
}
