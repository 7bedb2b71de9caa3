//! Sections with names, lengths and checksums, so that whatever is cut or changed is noticed and named.

use std::io::{self, Read, Write};

use sprung::{Code, Error, Result};

/// What a checkpoint begins with. No text does, and a copy that treats it as text changes it.
pub const MAGIC: [u8; 8] = *b"\x89sprung\n";

/// Bytes of the file's header: magic, version, number of sections, checksum.
const FILE_HEADER: usize = 20;
/// Bytes of a section's name, filled up with zeros.
const NAME_BYTES: usize = 16;
/// Bytes of a section's header: name, length, checksum of the content, checksum of the header.
const SECTION_HEADER: usize = NAME_BYTES + 16;
/// Sections there may be.
const MOST_SECTIONS: u32 = 1000;

/// Writes the file's header.
pub fn write_header(out: &mut impl Write, version: u32, sections: u32) -> io::Result<()> {
    let mut header = Vec::with_capacity(FILE_HEADER);
    header.extend(MAGIC);
    header.extend(version.to_le_bytes());
    header.extend(sections.to_le_bytes());
    header.extend(crc32fast::hash(&header).to_le_bytes());
    out.write_all(&header)
}

/// Writes one section.
pub fn write_section(out: &mut impl Write, name: &str, content: &[u8]) -> io::Result<()> {
    debug_assert!(name.len() <= NAME_BYTES);
    let mut header = Vec::with_capacity(SECTION_HEADER);
    header.extend(name.as_bytes());
    header.resize(NAME_BYTES, 0);
    header.extend((content.len() as u64).to_le_bytes());
    header.extend(crc32fast::hash(content).to_le_bytes());
    header.extend(crc32fast::hash(&header).to_le_bytes());
    out.write_all(&header)?;
    out.write_all(content)
}

/// A file being read.
pub struct Sections<'a, R> {
    file: &'a mut R,
    /// Bytes of the file that were not read yet.
    left: u64,
    sections_left: u32,
    /// The version of the format.
    pub version: u32,
}

impl<'a, R: Read> Sections<'a, R> {
    /// Reads the header of a file of so many bytes.
    pub fn open(file: &'a mut R, bytes: u64) -> Result<Self> {
        let mut sections = Self { file, left: bytes, sections_left: 0, version: 0 };
        let mut header = [0; FILE_HEADER];
        let there = bytes.min(FILE_HEADER as u64) as usize;
        sections.fill(&mut header[..there])?;
        if there == 0 || !MAGIC.starts_with(&header[..there.min(MAGIC.len())]) {
            return Err(Error::new(Code::Unreadable, "is no checkpoint: it does not begin like one"));
        }
        if there < FILE_HEADER {
            return Err(damaged("it ends within its header"));
        }
        if u32_at(&header, 16) != crc32fast::hash(&header[..16]) {
            return Err(damaged("its header does not match its checksum"));
        }
        sections.version = u32_at(&header, 8);
        sections.sections_left = u32_at(&header, 12);
        if sections.sections_left > MOST_SECTIONS {
            return Err(damaged("it claims too many sections"));
        }
        Ok(sections)
    }

    /// The next section's name and content; nothing after the last one.
    pub fn next(&mut self) -> Result<Option<(String, Vec<u8>)>> {
        if self.sections_left == 0 {
            return if self.left == 0 { Ok(None) } else { Err(damaged("bytes follow its last section")) };
        }
        self.sections_left -= 1;
        if self.left < SECTION_HEADER as u64 {
            return Err(damaged("it ends before its last section"));
        }
        let mut header = [0; SECTION_HEADER];
        self.fill(&mut header)?;
        if u32_at(&header, SECTION_HEADER - 4) != crc32fast::hash(&header[..SECTION_HEADER - 4]) {
            return Err(damaged("the header of a section does not match its checksum"));
        }
        let name = header[..NAME_BYTES].split(|&byte| byte == 0).next().unwrap_or_default();
        let name = String::from_utf8_lossy(name).escape_default().to_string();
        let length = u64::from_le_bytes(header[NAME_BYTES..NAME_BYTES + 8].try_into().unwrap_or_default());
        if length > self.left {
            let sentence = format!("the section `{name}` is cut off after {} of {length} bytes", self.left);
            return Err(damaged(&sentence));
        }
        // No more than the file has, but that may be more than there is memory.
        let mut content = Vec::new();
        let room = usize::try_from(length).ok().filter(|&length| content.try_reserve_exact(length).is_ok());
        let Some(room) = room else {
            let sentence = format!("the section `{name}` has {length} bytes, more than there is memory");
            return Err(Error::new(Code::TooLarge, sentence));
        };
        content.resize(room, 0);
        self.fill(&mut content)?;
        if u32_at(&header, NAME_BYTES + 8) != crc32fast::hash(&content) {
            return Err(damaged(&format!("the section `{name}` does not match its checksum")));
        }
        Ok(Some((name, content)))
    }

    fn fill(&mut self, bytes: &mut [u8]) -> Result<()> {
        self.left -= bytes.len() as u64;
        self.file.read_exact(bytes).map_err(|error| match error.kind() {
            io::ErrorKind::UnexpectedEof => damaged("it became shorter while it was read"),
            _ => Error::new(Code::Unreadable, format!("cannot be read: {error}")),
        })
    }
}

fn u32_at(bytes: &[u8], start: usize) -> u32 {
    u32::from_le_bytes([bytes[start], bytes[start + 1], bytes[start + 2], bytes[start + 3]])
}

/// The error for content that is not what was written.
pub fn damaged(what: &str) -> Error {
    Error::new(Code::Unreadable, format!("is damaged: {what}"))
}
