//! Bodies and answers are limited in size and time.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use edifice_studio::Settings;
use edifice_studio::guard::Limits;

use crate::socket::Server;

fn server(limits: Limits) -> Server {
    Server::start(&Settings {
        read_only: true,
        limits,
        ..Settings::default()
    })
}

fn head(server: &Server, length: usize) -> String {
    format!(
        "POST /api/documents HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nX-Edifice-Token: {}\r\nContent-Type: application/json\r\n\
         Connection: close\r\nContent-Length: {length}\r\n\r\n",
        server.port, server.token
    )
}

#[test]
fn a_body_may_be_so_large_and_no_larger() {
    let server = server(Limits {
        body: 100,
        ..Limits::default()
    });
    let body = |n: usize| format!("{{\"example\": \"{}\"}}", "x".repeat(n - 15));
    assert_eq!(body(100).len(), 100);
    assert_eq!(server.page("POST /api/documents", &body(100)).status, 422);
    assert_eq!(server.page("POST /api/documents", &body(101)).status, 413);
    // Without a length, in pieces.
    let pieces = format!("65\r\n{}\r\n0\r\n\r\n", body(101));
    let text =
        head(&server, 0).replace("Content-Length: 0", "Transfer-Encoding: chunked") + &pieces;
    assert_eq!(server.raw_open(text.as_bytes()).status, 413);
    assert_eq!(server.page("GET /api/documents", "").status, 200);
}

#[test]
fn a_body_that_does_not_come_is_not_waited_for() {
    let sending = Duration::from_millis(400);
    let server = server(Limits {
        sending,
        ..Limits::default()
    });
    let start = Instant::now();
    // A hundred clients that begin a body and say no more hold nothing up.
    let mut streams: Vec<TcpStream> = (0..100)
        .map(|_| {
            let mut stream = TcpStream::connect(("127.0.0.1", server.port)).expect("connects");
            let text = head(&server, 40) + "{\"exam";
            stream.write_all(text.as_bytes()).expect("sent");
            stream
        })
        .collect();
    assert_eq!(server.page("GET /api/documents", "").status, 200);
    for stream in &mut streams {
        let limit = Some(Duration::from_secs(30));
        stream.set_read_timeout(limit).expect("set");
        let mut answer = String::new();
        stream.read_to_string(&mut answer).expect("answered");
        assert!(answer.starts_with("HTTP/1.1 408"), "{answer}");
    }
    assert!(start.elapsed() >= sending);
}

#[test]
fn an_answer_that_takes_too_long_is_given_up() {
    let server = server(Limits {
        answering: Duration::from_millis(1),
        ..Limits::default()
    });
    // Its grammar is inferred first.
    let answer = server.page("POST /api/documents", "{\"example\": \"boulevard\"}");
    assert_eq!(answer.status, 504, "{}", answer.text);
    assert_eq!(server.page("GET /", "").status, 200);
}

#[test]
fn a_head_that_comes_slowly_or_not_at_all_is_not_waited_for() {
    let limit = Duration::from_millis(1500);
    let server = server(Limits {
        head: limit,
        ..Limits::default()
    });
    let connect = || TcpStream::connect(("127.0.0.1", server.port)).expect("connects");
    let start = Instant::now();
    // Fifty clients send a byte of a head now and then, and never the last one; fifty more say nothing; and one says nothing
    // more after its first request.
    let mut slow: Vec<(TcpStream, Option<Duration>)> = (0..50).map(|_| (connect(), None)).collect();
    let mut silent: Vec<TcpStream> = (0..50).map(|_| connect()).collect();
    let mut kept = connect();
    let request = format!("GET / HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n", server.port);
    kept.write_all(format!("{request}\r\n").as_bytes())
        .expect("sent");
    silent.push(kept);
    let head = format!("{request}X-Slow: {}", "a".repeat(10_000));
    for byte in head.bytes() {
        for (stream, closed) in slow.iter_mut().filter(|(_, closed)| closed.is_none()) {
            stream.set_nonblocking(true).expect("set");
            let ended = match stream.read(&mut [0; 64]) {
                Ok(count) => count == 0,
                Err(e) => e.kind() != std::io::ErrorKind::WouldBlock,
            };
            if ended || stream.write_all(&[byte]).is_err() {
                *closed = Some(start.elapsed());
            }
        }
        if slow.iter().all(|(_, closed)| closed.is_some()) {
            break;
        }
        // Others are answered meanwhile.
        let asked = Instant::now();
        assert_eq!(server.page("GET /api/documents", "").status, 200);
        assert!(asked.elapsed() < Duration::from_secs(10));
        std::thread::sleep(Duration::from_millis(100));
        assert!(start.elapsed() < Duration::from_secs(60), "still open");
    }
    for (_, closed) in &slow {
        let closed = closed.expect("closed");
        assert!(closed >= limit, "closed after {closed:?}");
    }
    for stream in &mut silent {
        let most = Some(Duration::from_secs(30));
        stream.set_read_timeout(most).expect("set");
        let mut answer = Vec::new();
        let read = stream.read_to_end(&mut answer);
        assert!(read.is_ok(), "still open: {read:?}");
    }
    // A head in pieces that is whole in time is answered.
    let mut pieces = connect();
    for piece in [request.as_str(), "Connection: ", "close\r\n\r\n"] {
        pieces.write_all(piece.as_bytes()).expect("sent");
        std::thread::sleep(Duration::from_millis(100));
    }
    let mut answer = String::new();
    pieces.read_to_string(&mut answer).expect("answered");
    assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
}
