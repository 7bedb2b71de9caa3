//! A server for the page on this machine.

use std::fs;
use std::path::{Component, Path};

use tiny_http::{Header, Response, Server};

use crate::shell::Outcome;

/// Where it is found.
const ADDRESS: &str = "127.0.0.1:8080";

/// What browsers must be told of files, by their endings.
const TYPES: [(&str, &str); 8] = [
    ("html", "text/html"),
    ("js", "text/javascript"),
    ("css", "text/css"),
    ("json", "application/json"),
    ("svg", "image/svg+xml"),
    ("txt", "text/plain; charset=utf-8"),
    ("wasm", "application/wasm"),
    ("webmanifest", "application/manifest+json"),
];

/// Serves a folder until Ctrl-C.
pub fn serve(folder: &Path) -> Outcome {
    let server =
        Server::http(ADDRESS).map_err(|error| format!("{ADDRESS} cannot be listened on: {error}"))?;
    println!("sprung is at http://{ADDRESS}; Ctrl-C ends it");
    for request in server.incoming_requests() {
        let path = request.url().split(['?', '#']).next().unwrap_or("").trim_start_matches('/').to_owned();
        let path = if path.is_empty() { "index.html".to_owned() } else { path };
        let stays = Path::new(&path).components().all(|part| matches!(part, Component::Normal(_)));
        let found = if stays { fs::read(folder.join(&path)).ok() } else { None };
        let answered = match found {
            Some(bytes) => {
                let ending = Path::new(&path).extension().and_then(|it| it.to_str()).unwrap_or("");
                let kind = TYPES
                    .iter()
                    .find(|(of, _)| *of == ending)
                    .map_or("application/octet-stream", |(_, kind)| kind);
                let header =
                    Header::from_bytes("Content-Type", kind).map_err(|()| "a header is wrong".to_owned())?;
                request.respond(Response::from_data(bytes).with_header(header))
            }
            None => request.respond(Response::from_string("there is no such file").with_status_code(404)),
        };
        // A browser that does not wait for an answer is its own affair.
        drop(answered);
    }
    Ok(())
}
