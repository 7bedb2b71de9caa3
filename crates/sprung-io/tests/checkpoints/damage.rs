//! Every cut and every flipped byte is noticed, and the section is named.

use sprung::Code;
use sprung_io::checkpoint::{MAGIC, Recording};

use crate::{bytes_of, read, small};

const SECTION_HEADER: usize = 32;

/// Where each section begins, and its name.
fn sections(bytes: &[u8]) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let mut at = 20;
    while at < bytes.len() {
        let name =
            bytes[at..at + 16].iter().take_while(|&&byte| byte != 0).map(|&byte| byte as char).collect();
        found.push((at, name));
        let length = u64::from_le_bytes(bytes[at + 16..at + 24].try_into().expect("eight bytes"));
        at += SECTION_HEADER + length as usize;
    }
    assert_eq!(at, bytes.len());
    found
}

#[test]
fn every_flipped_byte_is_noticed_and_its_section_named() {
    let whole = bytes_of(&small());
    let sections = sections(&whole);
    for index in 0..whole.len() {
        for mask in [1, 0x80, 0xff] {
            let mut bytes = whole.clone();
            bytes[index] ^= mask;
            let error = read(&bytes).expect_err("a byte is another");
            assert_eq!(error.code(), Code::Unreadable);
            let Some((start, name)) = sections.iter().rfind(|(start, _)| *start <= index) else {
                continue;
            };
            let text = error.to_string();
            let expected = if index < start + SECTION_HEADER {
                "is damaged: the header of a section does not match its checksum".to_owned()
            } else {
                format!("is damaged: the section `{name}` does not match its checksum")
            };
            assert_eq!(text, expected, "byte {index}");
        }
    }
}

#[test]
fn every_cut_is_noticed_and_its_section_named() {
    let whole = bytes_of(&small());
    let sections = sections(&whole);
    for length in 0..whole.len() {
        let text = read(&whole[..length]).expect_err("it is cut").to_string();
        assert!(text.starts_with("is damaged: ") || length < 1, "{length}: {text}");
        let within = sections.iter().rfind(|(start, _)| start + SECTION_HEADER <= length);
        if let Some((start, name)) = within {
            let end = sections.iter().find(|(next, _)| next > start).map_or(whole.len(), |(next, _)| *next);
            if length < end {
                assert!(text.contains(&format!("the section `{name}` is cut off after")), "{length}: {text}");
            }
        }
    }
    let mut longer = whole.clone();
    longer.push(0);
    assert_eq!(read(&longer).expect_err("too long").to_string(), "is damaged: bytes follow its last section");
}

/// The header anew, so that it is not the checksum that finds what is wrong.
fn with_header(bytes: &mut [u8], version: u32, count: u32) {
    bytes[8..12].copy_from_slice(&version.to_le_bytes());
    bytes[12..16].copy_from_slice(&count.to_le_bytes());
    let checksum = crc32fast::hash(&bytes[..16]);
    bytes[16..20].copy_from_slice(&checksum.to_le_bytes());
}

/// The checksums of a section anew.
fn with_checksums(bytes: &mut [u8], start: usize, end: usize) {
    let checksum = crc32fast::hash(&bytes[start + SECTION_HEADER..end]);
    bytes[start + 24..start + 28].copy_from_slice(&checksum.to_le_bytes());
    let checksum = crc32fast::hash(&bytes[start..start + 28]);
    bytes[start + 28..start + 32].copy_from_slice(&checksum.to_le_bytes());
}

#[test]
fn other_files_and_newer_versions_get_a_sentence() {
    let text = |bytes: &[u8]| read(bytes).expect_err("it is refused").to_string();
    for other in [&b""[..], b"[[body]]\nname = \"a\"\n", b"PK\x03\x04 and so on and so forth", &[0; 500]] {
        assert_eq!(text(other), "is no checkpoint: it does not begin like one");
    }
    assert_eq!(text(&MAGIC), "is damaged: it ends within its header");
    let mut newer = bytes_of(&small());
    with_header(&mut newer, 2, 17);
    let error = read(&newer).expect_err("it is newer");
    assert_eq!(error.code(), Code::Unsupported);
    assert!(error.to_string().starts_with("is in version 2 of the format"), "{error}");
    with_header(&mut newer, 0, 17);
    assert_eq!(text(&newer), "is damaged: it has no version of the format");
}

#[test]
fn what_has_right_checksums_and_wrong_content_gets_a_sentence() {
    let whole = bytes_of(&small());
    let sections = sections(&whole);
    let text = |bytes: &[u8]| read(bytes).expect_err("it is refused").to_string();

    // A count of everything there is, in every section that begins with one.
    for (number, (start, name)) in sections.iter().enumerate() {
        if ["scene", "clock", "parameters", "run"].contains(&name.as_str()) {
            continue;
        }
        let end = sections.get(number + 1).map_or(whole.len(), |(next, _)| *next);
        for count in [u64::MAX, u64::MAX / 12, 1 << 40] {
            let mut bytes = whole.clone();
            bytes[start + SECTION_HEADER..start + SECTION_HEADER + 8].copy_from_slice(&count.to_le_bytes());
            with_checksums(&mut bytes, *start, end);
            assert!(
                text(&bytes).starts_with(&format!("is damaged: the section `{name}` ")),
                "{}",
                text(&bytes)
            );
        }
    }
    // A length of everything there is.
    let (start, name) = &sections[3];
    let mut bytes = whole.clone();
    bytes[start + 16..start + 24].copy_from_slice(&u64::MAX.to_le_bytes());
    let checksum = crc32fast::hash(&bytes[*start..start + 28]);
    bytes[start + 28..start + 32].copy_from_slice(&checksum.to_le_bytes());
    assert!(text(&bytes).contains(&format!("the section `{name}` is cut off after")));
    // Sections that are missing, there twice, or that nobody knows.
    let mut bytes = whole[..sections[13].0].to_vec();
    with_header(&mut bytes, 1, 13);
    assert_eq!(text(&bytes), "is damaged: the section `cuts` is missing");
    let (from, to) = (sections[9].0, sections[10].0);
    let mut bytes = [&whole[..to], &whole[from..]].concat();
    with_header(&mut bytes, 1, 18);
    assert_eq!(text(&bytes), "is damaged: the section `pins` is there twice");
    let mut bytes = whole.clone();
    bytes[from..from + 4].copy_from_slice(b"p\x1b[0");
    with_checksums(&mut bytes, from, to);
    assert_eq!(text(&bytes), "is damaged: there is no section `p\\u{1b}[0` in version 1");
    with_header(&mut bytes, 1, u32::MAX);
    assert_eq!(text(&bytes), "is damaged: it claims too many sections");
    // Positions of another moment.
    let (start, end) = (sections[3].0, sections[4].0);
    let mut bytes = whole.clone();
    bytes[start + SECTION_HEADER + 9] ^= 1;
    with_checksums(&mut bytes, start, end);
    assert_eq!(text(&bytes), "is damaged: its positions and velocities do not match their hash");
    // A part that would lead out of the folder.
    let mut saved = small();
    if let Some(recording) = &mut saved.recording {
        recording.marks[1].files[1].part = "../../precious".into();
    }
    assert_eq!(
        text(&bytes_of(&saved)),
        "is damaged: the section `outputs` names a file that there cannot be"
    );
    // A run that there cannot be: whoever counts its steps or takes its marks relies on it.
    let spoils: [fn(&mut Recording); 6] = [
        |recording| recording.marks.truncate(2),
        |recording| recording.plan.steps_per_frame = 0,
        |recording| recording.plan.steps_per_frame = u64::MAX,
        |recording| recording.plan.last_frame = u64::MAX,
        |recording| recording.plan.recorded = recording.plan.last_frame + 2,
        |recording| recording.plan.from = recording.plan.last_frame + 1,
    ];
    for spoil in spoils {
        let mut saved = small();
        spoil(saved.recording.as_mut().expect("it is of a run"));
        assert_eq!(text(&bytes_of(&saved)), "is damaged: what it says of its run does not fit together");
    }
}

#[test]
fn numbers_that_are_none_are_refused_by_the_simulation() {
    let mut saved = small();
    saved.checkpoint.state.velocity[1].x = f32::NAN;
    let again = read(&bytes_of(&saved)).expect("it is whole");
    let error = crate::resumed(&again).expect_err("it is no motion");
    assert!(error.to_string().starts_with("velocity[1]: "), "{error}");
}
