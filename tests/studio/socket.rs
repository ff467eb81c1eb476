//! A studio that runs in a thread, asked over a real socket.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::Duration;

use edifice_studio::{Settings, start};

/// A running studio.
pub(crate) struct Server {
    pub port: u16,
    pub token: String,
}

/// An answer: status and everything sent.
pub(crate) struct Answer {
    pub status: u16,
    pub text: String,
}

impl Server {
    /// Starts one; it ends with the process.
    pub(crate) fn start(settings: &Settings) -> Self {
        let running = start(settings).expect("starts");
        let address = running.address().to_owned();
        let (place, token) = address.split_once("/#token=").expect("a token");
        let port = place.rsplit(':').next().and_then(|p| p.parse().ok());
        std::thread::spawn(move || running.serve(std::future::pending()));
        Self {
            port: port.expect("a port"),
            token: token.to_owned(),
        }
    }

    /// Sends bytes as they are, and nothing after them.
    pub(crate) fn raw(&self, bytes: &[u8]) -> Answer {
        self.send(bytes, true)
    }

    /// Sends bytes as they are, and stays.
    pub(crate) fn raw_open(&self, bytes: &[u8]) -> Answer {
        self.send(bytes, false)
    }

    fn send(&self, bytes: &[u8], ends: bool) -> Answer {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).expect("connects");
        let limit = Some(Duration::from_secs(30));
        stream.set_read_timeout(limit).expect("set");
        // A server that refuses may close before all was sent.
        let _ = stream.write_all(bytes);
        // To the server a client that ends its side is gone: whoever wants the answer stays.
        if ends {
            let _ = stream.shutdown(std::net::Shutdown::Write);
        }
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        let text = String::from_utf8_lossy(&answer).into_owned();
        let status = text.split(' ').nth(1).and_then(|s| s.parse().ok());
        Answer {
            status: status.unwrap_or(0),
            text,
        }
    }

    /// A request with these headers; without `host` among them the server's own.
    pub(crate) fn ask(&self, line: &str, headers: &[(&str, &str)], body: &str) -> Answer {
        let mut text = format!("{line} HTTP/1.1\r\nConnection: close\r\n");
        if !headers.iter().any(|(n, _)| n.eq_ignore_ascii_case("host")) {
            text.push_str(&format!("Host: 127.0.0.1:{}\r\n", self.port));
        }
        for (name, value) in headers {
            text.push_str(&format!("{name}: {value}\r\n"));
        }
        if !body.is_empty() {
            text.push_str(&format!("Content-Length: {}\r\n", body.len()));
        }
        self.send(format!("{text}\r\n{body}").as_bytes(), false)
    }

    /// A request as the page makes it.
    pub(crate) fn page(&self, line: &str, body: &str) -> Answer {
        let own = format!("http://127.0.0.1:{}", self.port);
        let mut headers = vec![
            ("X-Edifice-Token", self.token.as_str()),
            ("Origin", own.as_str()),
            ("Sec-Fetch-Site", "same-origin"),
        ];
        if !body.is_empty() {
            headers.push(("Content-Type", "application/json"));
        }
        self.ask(line, &headers, body)
    }
}
