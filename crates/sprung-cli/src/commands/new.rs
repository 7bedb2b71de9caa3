//! `sprung new`: a commented scene file to start from.

use std::io::Write;

use sprung::{Code, Error, Result, scene};
use sprung_io::PartialFile;
use sprung_io::files::write_error;

use crate::args::NewArgs;
use crate::console;

pub fn run(args: &NewArgs) -> Result<()> {
    let path = &args.file;
    let name = path.display().to_string();
    // Whatever has the name: a file, a folder, a pipe, or a link, even one that leads nowhere.
    if path.symlink_metadata().is_ok() {
        let error = Error::new(Code::Unwritable, "exists already and is left as it is").in_file(name);
        return Err(error.with_fix("give another name"));
    }
    let mut file = PartialFile::create(path)?;
    file.write_all(scene::STARTER.as_bytes()).map_err(|error| write_error(path, &error))?;
    file.finish()?;
    console::say(format_args!(
        "Wrote {name}. Edit it, then try `sprung show {name}` and `sprung run {name} -o out.gif`."
    ));
    Ok(())
}
