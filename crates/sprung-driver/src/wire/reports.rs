//! Reports: what has changed since the one before.
//!
//! Small things are always sent. Of what is large and shared, both ends hold what the last report held: it is named where it
//! is the same. Snapshots are the bulk of it, and of one that plays there are two: the step before the newest is sent only
//! where it is not the newest of the last report.

use std::sync::Arc;

use sprung::Result;
use sprung_io::{Pack, Unpack};

use crate::command::Source;
use crate::options::Options;
use crate::report::{Comparison, Opened, Report, Sample, Stability, Timeline, Trouble};
use crate::samples::Samples;

use super::pictures::{
    check_length, read_checkpoint, read_params, read_snapshot, write_checkpoint, write_params, write_snapshot,
};
use super::shared::{never, read_grown, read_known, write_grown, write_known};
use super::{FromHost, Wire, damaged, enums, structs};

/// Room for all that is small, bytes.
const SMALL_BYTES: usize = 4096;

structs! {
    Stability { certified, sharp, sharp_step, every_configuration }
    Sample { step, time, energy, values }
}

enums! {
    Trouble { 0 BlewUp(blow_up), 1 Refused(error) }
}

/// Makes bytes of one report after another.
pub(crate) struct Writer {
    last: Arc<Report>,
}

/// Makes the reports of these bytes.
pub(crate) struct Reader {
    pub last: Arc<Report>,
    options: Options,
}

impl Writer {
    /// The other end has this report already.
    pub fn new(first: Arc<Report>) -> Self {
        Self { last: first }
    }

    pub fn last(&self) -> &Arc<Report> {
        &self.last
    }

    /// What has changed since the last report.
    pub fn write(&mut self, report: &Arc<Report>) -> Vec<u8> {
        let last = std::mem::replace(&mut self.last, report.clone());
        let points = report.opened.model.point_count();
        let mut pack = Pack::with_capacity(SMALL_BYTES + 2 * size_of::<sprung::Vec3>() * points);
        FromHost::begin_report(&mut pack);
        write(&mut pack, report, &last);
        pack.into_bytes()
    }
}

impl Reader {
    /// This end has this report already. The options say how much memory a scene may take.
    pub fn new(first: Arc<Report>, options: Options) -> Self {
        Self { last: first, options }
    }

    /// The report that these bytes make of the last one.
    ///
    /// # Errors
    /// If they do not; then nothing can be made of later ones.
    pub fn read(&mut self, bytes: &[u8]) -> Result<()> {
        let mut unpack = Unpack::new(bytes);
        let report = read(&mut unpack, &self.last, &self.options)?;
        unpack.end()?;
        self.last = Arc::new(report);
        Ok(())
    }
}

fn write(pack: &mut Pack, report: &Report, last: &Report) {
    let Report {
        opened,
        params,
        before,
        now,
        blend,
        forces,
        energy,
        ledger_is_whole,
        playing,
        pace,
        speed,
        seconds_per_step,
        auto_substeps,
        stability,
        timeline,
        undo,
        redo,
        pull,
        comparison,
        watched,
        samples,
        trouble,
        fixes,
        checkpoint,
        busy,
    } = report;
    if write_known(pack, opened, &[&last.opened], never) {
        write_opened(pack, opened);
    }
    write_params(pack, params, &[&last.params, &opened.params]);
    write_snapshot(pack, now, &[&last.now, &last.before, &opened.first]);
    write_snapshot(pack, before, &[now, &last.now, &last.before, &opened.first]);
    blend.write(pack);
    forces.is_some().write(pack);
    if let Some(forces) = forces
        && write_known(pack, forces, &last.forces.as_known(), never)
    {
        pack.vec3s(forces);
    }
    energy.write(pack);
    for answer in [ledger_is_whole, playing, auto_substeps] {
        answer.write(pack);
    }
    pace.write(pack);
    (*speed, *seconds_per_step).write(pack);
    stability.write(pack);
    write_timeline(pack, timeline, &last.timeline);
    for text in [undo, redo, busy] {
        text.write(pack);
    }
    pull.write(pack);
    comparison.is_some().write(pack);
    if let Some(Comparison { snapshot, parted, apart }) = comparison {
        let known = last.comparison.as_ref().map_or(&opened.first, |last| &last.snapshot);
        write_snapshot(pack, snapshot, &[known, now]);
        (*parted, *apart).write(pack);
    }
    if write_known(pack, watched, &[&last.watched], never) {
        watched.write(pack);
    }
    write_samples(pack, samples, &last.samples);
    trouble.write(pack);
    fixes.write(pack);
    checkpoint.is_some().write(pack);
    if let Some(checkpoint) = checkpoint
        && write_known(pack, checkpoint, &last.checkpoint.as_known(), never)
    {
        write_checkpoint(pack, checkpoint, &[params, &opened.params]);
    }
}

fn read(read: &mut Unpack<'_>, last: &Report, options: &Options) -> Result<Report> {
    let opened = read_known(read, &[&last.opened], |read| read_opened(read, options))?;
    let model = &*opened.model;
    let params = read_params(read, &[&last.params, &opened.params], model)?;
    let now = read_snapshot(read, &[&last.now, &last.before, &opened.first], model)?;
    let before = read_snapshot(read, &[&now, &last.now, &last.before, &opened.first], model)?;
    let blend = Wire::read(read)?;
    let forces = if bool::read(read)? {
        let forces = read_known(read, &last.forces.as_known(), Unpack::vec3s)?;
        check_length(&forces, model)?;
        Some(forces)
    } else {
        None
    };
    let energy = Wire::read(read)?;
    let [ledger_is_whole, playing, auto_substeps] = [bool::read(read)?, bool::read(read)?, bool::read(read)?];
    let pace = Wire::read(read)?;
    let (speed, seconds_per_step) = Wire::read(read)?;
    let stability = Wire::read(read)?;
    let timeline = read_timeline(read, &last.timeline)?;
    let [undo, redo, busy] = [Wire::read(read)?, Wire::read(read)?, Wire::read(read)?];
    let pull = Option::<(usize, _)>::read(read)?;
    if pull.is_some_and(|(point, _)| point >= model.point_count()) {
        return Err(damaged("pulls at a point that there is not"));
    }
    let comparison = if bool::read(read)? {
        let known = last.comparison.as_ref().map_or(&opened.first, |last| &last.snapshot);
        let snapshot = read_snapshot(read, &[known, &now], model)?;
        let (parted, apart) = Wire::read(read)?;
        Some(Comparison { snapshot, parted, apart })
    } else {
        None
    };
    let watched = read_known(read, &[&last.watched], Wire::read)?;
    let samples = read_samples(read, &last.samples)?;
    let trouble = Wire::read(read)?;
    let fixes = Wire::read(read)?;
    let checkpoint = if bool::read(read)? {
        let known = &last.checkpoint.as_known();
        Some(read_known(read, known, |read| read_checkpoint(read, &[&params, &opened.params], model))?)
    } else {
        None
    };
    Ok(Report {
        params,
        before,
        now,
        blend,
        forces,
        energy,
        ledger_is_whole,
        playing,
        pace,
        speed,
        seconds_per_step,
        auto_substeps,
        stability,
        timeline,
        undo,
        redo,
        pull,
        comparison,
        watched,
        samples,
        trouble,
        fixes,
        checkpoint,
        busy,
        opened,
    })
}

/// The one that there is, if there is one, as a list of what is known.
trait Known<T> {
    fn as_known(&self) -> Vec<&Arc<T>>;
}

impl<T> Known<T> for Option<Arc<T>> {
    fn as_known(&self) -> Vec<&Arc<T>> {
        self.iter().collect()
    }
}

/// The scene, and its first moment: the model is built anew from it.
fn write_opened(pack: &mut Pack, opened: &Opened) {
    let Opened { serial, name, scene, model, params, first } = opened;
    pack.u64(*serial).u64(model.fingerprint());
    pack.text(name);
    scene.write(pack);
    pack.params(params).snapshot(first);
}

fn read_opened(read: &mut Unpack<'_>, options: &Options) -> Result<Opened> {
    let (serial, fingerprint) = (read.u64()?, read.u64()?);
    let Source { name, scene } = Source::read(read)?;
    options.check_memory(scene.estimated_bytes(), &name)?;
    let (model, _, _) = scene.build()?;
    let (params, first) = (read.params()?, read.snapshot()?);
    params.validate(&model)?;
    check_length(&first.positions, &model)?;
    check_length(&first.velocities, &model)?;
    if model.fingerprint() != fingerprint {
        return Err(damaged("has a scene that is built differently here"));
    }
    let (model, params, first) = (Arc::new(model), Arc::new(params), Arc::new(first));
    Ok(Opened { serial, name, scene, model, params, first })
}

fn write_timeline(pack: &mut Pack, timeline: &Timeline, last: &Timeline) {
    let Timeline { first, newest, marks, clock, bytes } = timeline;
    (*first, *newest, *bytes).write(pack);
    write_grown(pack, marks, &last.marks);
    write_grown(pack, clock, &last.clock);
}

fn read_timeline(read: &mut Unpack<'_>, last: &Timeline) -> Result<Timeline> {
    let (first, newest, bytes) = Wire::read(read)?;
    let (marks, clock) = (read_grown(read, &last.marks)?, read_grown(read, &last.clock)?);
    Ok(Timeline { first, newest, marks, clock, bytes })
}

/// Of the samples, those behind what both have.
fn write_samples(pack: &mut Pack, samples: &Samples, last: &Samples) {
    let kept = samples.in_common_with(last);
    (samples.first(), samples.every()).write(pack);
    (kept, samples.len() - kept).write(pack);
    (kept..samples.len()).for_each(|index| samples[index].write(pack));
}

fn read_samples(read: &mut Unpack<'_>, last: &Samples) -> Result<Samples> {
    let (first, every) = Wire::read(read)?;
    let kept = usize::read(read)?;
    let more = Vec::read(read)?;
    last.continued(kept, first, every, more).ok_or_else(|| damaged("keeps more samples than there are"))
}
