//! A front end here and its driver in `web/worker.js`, in WebAssembly under Node.js: what it says is what one here says, to the bit.
//!
//! SPRUNG_ENGINE names the folder with the module, as wasm-bindgen leaves it: `engine.js` and `engine_bg.wasm`. Without, there
//! is nothing to test.

use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command as Program, Stdio};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use sprung::Change;
use sprung::scene::Scene;
use sprung_driver::{Command, Driver, Edit, Handle, Options, Report, Source, Timeline, Trouble, Word};

/// Longer than anything here takes on any machine: only a hang gets there.
const HANG: Duration = Duration::from_secs(120);

/// A front end, and the program that its driver is in.
struct Page {
    handle: Handle,
    child: Child,
    stdin: Arc<Mutex<Option<ChildStdin>>>,
    has_come: Receiver<()>,
}

impl Page {
    /// `None` where there is no module.
    fn open(name: &str) -> Option<Self> {
        let folder = PathBuf::from(std::env::var_os("SPRUNG_ENGINE")?);
        let here = Path::new(env!("CARGO_MANIFEST_DIR"));
        std::fs::copy(here.join("../../web/worker.js"), folder.join("worker.js")).expect("it can be copied");
        let mut child = Program::new("node")
            .arg(here.join("tests/host.mjs"))
            .arg(folder)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("Node.js is there");
        let stdin = Arc::new(Mutex::new(child.stdin.take()));
        let mut stdout = child.stdout.take().expect("it is piped");
        let mut stderr = child.stderr.take().expect("it is piped");
        let (words, said) = channel();
        let (comes, has_come) = channel();
        std::thread::spawn(move || {
            while let Some(message) = message(&mut stdout) {
                tell(&words, &comes, Word::Message(message));
            }
            let mut reason = String::new();
            let _ = stderr.read_to_string(&mut reason);
            tell(&words, &comes, Word::Ended(reason));
        });
        let theirs = stdin.clone();
        let post = Box::new(move |message: Vec<u8>| {
            if let Some(stdin) = theirs.lock().expect("nobody dies").as_mut() {
                let length = (message.len() as u32).to_le_bytes();
                let _ = stdin.write_all(&length).and_then(|()| stdin.write_all(&message));
            }
        });
        let handle = Handle::remote(source(name), Options::default(), post, said).expect("it opens");
        Some(Self { handle, child, stdin, has_come })
    }

    fn until(&mut self, what: &str, holds: impl Fn(&Report) -> bool) -> Arc<Report> {
        loop {
            let report = self.handle.report();
            if holds(&report) {
                return report;
            }
            let word = self.has_come.recv_timeout(HANG);
            assert!(word.is_ok(), "waiting for {what}, it went quiet: {:?}", report.trouble);
        }
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        // It ends when nobody speaks to it any more.
        self.stdin.lock().map(|mut stdin| stdin.take()).ok();
        let _ = self.child.wait();
    }
}

fn tell(words: &Sender<Word>, comes: &Sender<()>, word: Word) {
    // The test may have ended by then.
    let _ = words
        .send(word)
        .and_then(|()| comes.send(()).map_err(|_| std::sync::mpsc::SendError(Word::Ended(String::new()))));
}

/// The next message, after its length.
fn message(from: &mut impl Read) -> Option<Vec<u8>> {
    let mut length = [0; 4];
    from.read_exact(&mut length).ok()?;
    let mut message = vec![0; u32::from_le_bytes(length) as usize];
    from.read_exact(&mut message).ok()?;
    Some(message)
}

fn source(name: &str) -> Source {
    Source { name: name.to_owned(), scene: Scene::builtin(name).expect("a built-in scene") }
}

/// The step at which something is changed.
const CHANGED: u64 = 20;

/// Some steps with what is changed meanwhile.
fn work(springs: usize) -> Vec<Command> {
    let mut commands: Vec<_> = (0..60).map(|_| Command::Step).collect();
    let softer = Edit::new("softer", vec![Change::Stiffness(0..springs, 90.0), Change::Dt(0.004)]);
    commands.insert(CHANGED as usize, Command::Edit(softer));
    commands
}

#[test]
fn a_driver_in_webassembly_has_the_same_bits() {
    let mut names = ["spring", "chain", "cloth", "jelly"].into_iter();
    let Some(mut page) = names.next().and_then(Page::open) else { return };
    loop {
        let here = page.handle.report();
        let mut alone = Driver::new(source(&here.opened.name)).expect("it opens");
        for command in work(here.opened.model.spring_count()) {
            page.handle.send(command.clone());
            alone.obey(command);
            alone.advance(0.0, &mut || true);
        }
        let there = page.until("all steps", |report| report.now.step == 60 && report.busy.is_none());
        let here = alone.report();
        assert_eq!((&there.now, &there.before), (&here.now, &here.before), "{}", here.opened.name);
        assert_eq!((there.energy, &there.params), (here.energy, &here.params));
        // Where something was changed, a sample is taken once more if somebody asks just then.
        let samples = |report: &Report| {
            report.samples.iter().filter(|sample| sample.step != CHANGED).cloned().collect::<Vec<_>>()
        };
        assert_eq!(samples(&there), samples(&here));
        // But for the memory that it takes, which is less where addresses are shorter.
        let past = |report: &Report| Timeline { bytes: (0, 0), ..report.timeline.clone() };
        assert_eq!((&there.undo, past(&there)), (&here.undo, past(&here)));
        let Some(name) = names.next() else { break };
        let serial = there.opened.serial + 1;
        page.handle.send(Command::Open(Box::new(source(name))));
        page.until(name, |report| report.opened.serial == serial && report.busy.is_none());
    }
}

#[test]
fn it_plays_by_its_own_clock_and_tells_when_it_is_gone() {
    let Some(mut page) = Page::open("jelly") else { return };
    page.handle.send(Command::Play(true));
    page.until("some steps", |report| report.now.step > 30 && report.seconds_per_step > 0.0);
    page.child.kill().expect("it runs");
    let report = page.until("its end", |report| report.trouble.is_some());
    assert!(
        matches!(&report.trouble, Some(Trouble::Refused(error)) if error.sentence().contains("for good"))
    );
    assert!(!report.playing);
}
