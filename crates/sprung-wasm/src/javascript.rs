//! Values on their way to JavaScript and from it: errors, objects, whole numbers.

use js_sys::{Array, Object, Reflect};
use sprung::{BlowUp, Cause, Code, Error, Result, Vec3};
use wasm_bindgen::JsValue;

/// What a door gives: a value, or what is to be thrown.
pub type Thrown<T = ()> = Result<T, JsValue>;

/// The largest whole number up to which all are exact in a JavaScript number.
const LARGEST_WHOLE: f64 = 9_007_199_254_740_991.0;

/// An object under construction.
pub struct Fields(Object);

impl Fields {
    pub fn new() -> Self {
        Self(Object::new())
    }

    pub fn with(self, name: &str, value: impl Into<JsValue>) -> Self {
        // It cannot fail: the object is our own, and nothing is frozen.
        let _ = Reflect::set(&self.0, &name.into(), &value.into());
        self
    }

    /// The same, or nothing where there is no value.
    pub fn with_some(self, name: &str, value: Option<impl Into<JsValue>>) -> Self {
        match value {
            Some(value) => self.with(name, value),
            None => self,
        }
    }

    pub fn done(self) -> JsValue {
        self.0.into()
    }
}

/// A JavaScript `Error` whose message is the command's sentence, with its parts beside.
pub fn thrown(error: Error) -> JsValue {
    let place = error.place();
    let (line, column) = place.line_column.unzip();
    let parts = Fields::new()
        .with("code", format!("{:?}", error.code()))
        .with("sentence", error.sentence())
        .with_some("file", place.file.clone())
        .with_some("line", line.map(|line| line as f64))
        .with_some("column", column.map(|column| column as f64))
        .with_some("field", place.field.clone())
        .with_some("fix", error.fix())
        .with_some("blowUp", error.blow_up().map(blow_up))
        .done();
    let thrown = js_sys::Error::new(&error.to_string());
    let _ = Reflect::set(&thrown, &"parts".into(), &parts);
    thrown.into()
}

fn blow_up(blow_up: &BlowUp) -> JsValue {
    let (reason, excess) = match blow_up.cause {
        Cause::NotFinite => ("not-finite", None),
        Cause::EnergyFromNowhere { excess } => ("energy-from-nowhere", Some(excess)),
    };
    Fields::new()
        .with("reason", reason)
        .with_some("excess", excess)
        .with("step", blow_up.step as f64)
        .with("time", blow_up.time)
        .with("goodStep", blow_up.good_step as f64)
        .with("goodTime", blow_up.good_time)
        .with_some("spring", blow_up.spring.map(|spring| spring as f64))
        .with("points", blow_up.points.iter().map(|&point| JsValue::from(point as f64)).collect::<Array>())
        .with("place", blow_up.place.as_str())
        .with("dt", blow_up.dt)
        .with_some("certifiedLimit", blow_up.dt_limit_certified)
        .with_some("everyConfigurationLimit", blow_up.dt_limit_every_configuration)
        .with_some("suggestedDt", blow_up.suggested_dt())
        .with_some("suggestedDampingScale", blow_up.suggested_damping_scale())
        .done()
}

/// A whole number from 0 up, such as an index or a count. JavaScript has only float64.
pub fn whole(field: &str, value: f64) -> Result<u64> {
    if (0.0..=LARGEST_WHOLE).contains(&value) && value.fract() == 0.0 {
        return Ok(value as u64);
    }
    let sentence = format!("is {value}, and must be a whole number of at least 0");
    Err(Error::new(Code::OutOfRange, sentence).at_field(field))
}

/// An index, or the end of a range of them.
pub fn index(field: &str, value: f64) -> Result<usize> {
    // On 32 bits a larger one is beyond every list, as the largest there is.
    whole(field, value).map(|index| usize::try_from(index).unwrap_or(usize::MAX))
}

/// Three numbers as the engine keeps them.
pub fn vector(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x as f32, y as f32, z as f32)
}

/// Bytes that are asked for at once: the largest list that there can be on 32 bits is just below twice as long.
const PORTION: u64 = 1 << 30;

/// Refuses what needs more memory than there is.
pub fn room_for(bytes: u64, what: &str) -> Result<()> {
    // Asked for and given back at once: what the memory has grown by stays, and is there for what is built now.
    let mut portions = Vec::new();
    let mut left = bytes;
    while left > 0 {
        let portion = left.min(PORTION);
        let mut taken = Vec::<u8>::new();
        if taken.try_reserve_exact(portion as usize).is_err() {
            let sentence = format!(
                "{what} needs about {:.2} GB of memory, which are not to be had here",
                bytes as f64 / 1e9
            );
            let error = Error::new(Code::TooLarge, sentence);
            return Err(error.with_fix("use fewer points or a smaller radius"));
        }
        // Or the compiler may find out that nobody reads it, and not ask at all.
        portions.push(std::hint::black_box(taken));
        left -= portion;
    }
    Ok(())
}
