//! Each attack over a real socket, and its refusal.

use edifice::rng::stream;
use edifice_studio::Settings;
use rand::RngExt;

use crate::socket::Server;

fn server() -> Server {
    Server::start(&Settings {
        read_only: true,
        ..Settings::default()
    })
}

#[test]
fn the_page_and_its_requests_are_answered() {
    let server = server();
    let page = server.ask("GET /", &[], "");
    assert_eq!(page.status, 200);
    let policy = "content-security-policy: default-src 'none'; script-src 'self';";
    assert!(page.text.contains(policy), "{}", page.text);
    assert!(!page.text.contains("<script>") && !page.text.contains("unsafe-inline"));
    assert!(!page.text.contains("access-control-allow-origin"));
    assert_eq!(server.page("GET /api/documents", "").status, 200);
    let opened = server.page("POST /api/documents", "{\"example\": \"four\"}");
    assert_eq!(opened.status, 200, "{}", opened.text);
    let name = format!("localhost:{}", server.port);
    let headers = [
        ("Host", name.as_str()),
        ("X-Edifice-Token", server.token.as_str()),
    ];
    assert_eq!(server.ask("GET /api/documents", &headers, "").status, 200);
}

#[test]
fn a_foreign_host_is_refused_before_routing() {
    // A name that is bound to 127.0.0.1 again after the page was loaded (rebinding): no Origin is sent, the token may be known.
    let server = server();
    let token = ("X-Edifice-Token", server.token.as_str());
    let port = server.port;
    for host in [
        format!("evil.example:{port}"),
        "127.0.0.1".to_owned(),
        format!("127.0.0.1:{}", port.wrapping_add(1)),
        format!("127.0.0.1:{port}.evil.example"),
        format!("localhost.:{port}"),
        format!("0.0.0.0:{port}"),
        format!("[::1]:{port}"),
        format!("user@127.0.0.1:{port}"),
        String::new(),
    ] {
        for line in [
            "GET /",
            "GET /api/documents",
            "GET /no/such/page",
            "DELETE /api/documents",
        ] {
            let answer = server.ask(line, &[("Host", &host), token], "");
            assert!(
                matches!(answer.status, 403 | 400),
                "{host} {line}: {}",
                answer.text
            );
            assert!(!answer.text.contains("example"), "{}", answer.text);
        }
    }
    // Two of them, and another in the request's own line.
    let own = format!("127.0.0.1:{port}");
    let both = [("Host", own.as_str()), ("Host", "evil.example"), token];
    assert_eq!(server.ask("GET /api/documents", &both, "").status, 403);
    let line = "GET http://evil.example/api/documents";
    let answer = server.ask(line, &[("Host", own.as_str()), token], "");
    assert!(matches!(answer.status, 400 | 403), "{}", answer.text);
}

#[test]
fn a_foreign_origin_and_a_foreign_site_are_refused() {
    let server = server();
    let token = ("X-Edifice-Token", server.token.as_str());
    for origin in [
        "http://evil.example".to_owned(),
        "null".to_owned(),
        format!("https://127.0.0.1:{}", server.port),
        format!("http://127.0.0.1:{}", server.port.wrapping_add(1)),
        format!("http://127.0.0.1:{}.evil.example", server.port),
        "http://127.0.0.1".to_owned(),
    ] {
        let headers = [
            token,
            ("Origin", origin.as_str()),
            ("Content-Type", "application/json"),
        ];
        let answer = server.ask("POST /api/documents", &headers, "{\"example\": \"four\"}");
        assert_eq!(answer.status, 403, "{origin}: {}", answer.text);
    }
    for site in ["cross-site", "same-site", "CROSS-SITE", ""] {
        for line in ["GET /", "GET /app.js", "GET /api/documents"] {
            let answer = server.ask(line, &[token, ("Sec-Fetch-Site", site)], "");
            assert_eq!(answer.status, 403, "{site} {line}: {}", answer.text);
        }
    }
}

#[test]
fn a_window_may_come_from_elsewhere_to_the_page_alone() {
    let server = server();
    let from = |site| {
        [
            ("Sec-Fetch-Site", site),
            ("Sec-Fetch-Mode", "navigate"),
            ("Sec-Fetch-Dest", "document"),
        ]
    };
    let page = server.ask("GET /", &from("cross-site"), "");
    assert_eq!(page.status, 200, "{}", page.text);
    assert!(page.text.contains("frame-ancestors 'none'"));
    for line in ["GET /app.js", "GET /api/documents", "POST /", "GET /?x"] {
        let allowed = line == "GET /?x";
        let answer = server.ask(line, &from("cross-site"), "");
        assert_eq!(answer.status == 200, allowed, "{line}: {}", answer.text);
    }
    let frame = [
        ("Sec-Fetch-Site", "cross-site"),
        ("Sec-Fetch-Mode", "navigate"),
        ("Sec-Fetch-Dest", "iframe"),
    ];
    assert_eq!(server.ask("GET /", &frame, "").status, 403);
    assert_eq!(server.ask("GET /", &from("same-site"), "").status, 403);
}

#[test]
fn without_the_token_there_is_no_answer() {
    let server = server();
    let wrong = "0".repeat(server.token.len());
    let longer = format!("{}0", server.token);
    for token in ["", &wrong, &server.token[1..], &longer] {
        for line in [
            "GET /api/documents",
            "GET /api/documents/d1",
            "GET /api/none",
            "GET /api",
        ] {
            let answer = server.ask(line, &[("X-Edifice-Token", token)], "");
            assert_eq!(answer.status, 401, "{token} {line}: {}", answer.text);
        }
    }
    assert_eq!(server.ask("GET /api/documents", &[], "").status, 401);
    // Neither in the address, nor as a cookie.
    let line = format!("GET /api/documents?token={}", server.token);
    assert_eq!(server.ask(&line, &[], "").status, 401);
    let cookie = format!("token={}", server.token);
    assert_eq!(
        server
            .ask("GET /api/documents", &[("Cookie", &cookie)], "")
            .status,
        401
    );
    // Two servers have two tokens.
    assert_ne!(server.token, self::server().token);
    assert_eq!(server.token.len(), 32);
}

#[test]
fn bodies_are_json_and_limited() {
    let server = server();
    let token = ("X-Edifice-Token", server.token.as_str());
    for kind in [
        "text/plain",
        "application/x-www-form-urlencoded",
        "multipart/form-data",
        "",
    ] {
        let headers = [token, ("Content-Type", kind)];
        let answer = server.ask("POST /api/documents", &headers, "{\"example\": \"four\"}");
        assert_eq!(answer.status, 415, "{kind}: {}", answer.text);
    }
    for line in [
        "PUT /api/documents",
        "DELETE /api/documents/d1",
        "OPTIONS /api/documents",
        "TRACE /",
    ] {
        assert_eq!(server.page(line, "").status, 405, "{line}");
    }
    let large = format!("{{\"example\": \"{}\"}}", "x".repeat(5 << 20));
    let answer = server.page("POST /api/documents", &large);
    // The server may hang up on the rest of what it does not read.
    assert!(matches!(answer.status, 413 | 0), "{}", answer.status);
    assert_eq!(
        server.page("POST /api/documents", "{\"example\": ").status,
        400
    );
    assert_eq!(
        server
            .page("POST /api/documents", "{\"example\": \"none\"}")
            .status,
        422
    );
    assert_eq!(
        server
            .page("POST /api/documents", "{\"path\": \"/etc/passwd\"}")
            .status,
        400
    );
    assert_eq!(server.page("GET /api/documents", "").status, 200);
}

#[test]
fn no_address_leads_out_of_what_is_open() {
    let server = server();
    for path in [
        "/../Cargo.toml",
        "/%2e%2e/%2e%2e/etc/passwd",
        "/assets/../../etc/passwd",
        "//etc/passwd",
        "/api/documents/../../etc/passwd",
        "/api/documents/%2e%2e%2fetc%2fpasswd",
        "/api/documents//etc/passwd",
        "/api/documents/d0",
        "/api/documents/d1",
        "/api/documents/d-1",
        "/api/documents/d99999999999999999999",
        "/api/documents/d1/export/..%2f..%2fetc%2fpasswd",
    ] {
        let answer = server.page(&format!("GET {path}"), "");
        assert!(
            matches!(answer.status, 404 | 422 | 400),
            "{path}: {}",
            answer.text
        );
        assert!(!answer.text.contains("root:") && !answer.text.contains("[package]"));
    }
}

#[test]
fn it_listens_on_the_loopback_address_only() {
    let server = server();
    let text = std::fs::read_to_string("/proc/net/tcp").unwrap_or_default();
    let port = format!("{:04X}", server.port);
    let listening = text.lines().filter_map(|line| {
        let fields: Vec<&str> = line.split_whitespace().collect();
        (fields.get(3) == Some(&"0A"))
            .then(|| fields[1].split_once(':'))
            .flatten()
    });
    let own: Vec<_> = listening.filter(|(_, p)| *p == port).collect();
    if cfg!(target_os = "linux") {
        assert_eq!(own, [("0100007F", port.as_str())]);
    }
    let six = std::fs::read_to_string("/proc/net/tcp6").unwrap_or_default();
    assert!(
        !six.lines()
            .any(|l| l.contains(&format!(":{port} ")) && l.contains(" 0A "))
    );
}

#[test]
fn ten_thousand_random_requests_leave_it_answering() {
    let server = server();
    assert_eq!(
        server
            .page("POST /api/documents", "{\"example\": \"four\"}")
            .status,
        200
    );
    let mut rng = stream(7, "studio/random requests", 0);
    let paths = [
        "/",
        "/api/documents",
        "/api/documents/d1",
        "/api/documents/d1/edit",
        "/api/documents/d1/undo",
        "/x",
    ];
    let bodies = [
        "{}",
        "{\"commands\": [], \"revision\": 0}",
        "{\"commands\": [{\"do\": \"edit\", \"edits\": [\"add window@0,0,1,1\"]}], \"revision\": 0}",
        "{\"commands\": [{\"do\": \"edit\", \"edits\": [\"add window@1e999,0,1,1\"]}], \"revision\": 1}",
        "{\"commands\": [{\"do\": \"complete\", \"count\": 1000000000}], \"revision\": 1}",
        "[[[[[[",
        "\u{0}\u{ffff}",
    ];
    for k in 0..10_000 {
        let path = paths[rng.random_range(0..paths.len())];
        if k % 4 == 0 {
            // Bytes that are no request, or part of one.
            let mut bytes = format!(
                "POST {path} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n",
                server.port
            )
            .into_bytes();
            for _ in 0..rng.random_range(1..20) {
                let at = rng.random_range(0..bytes.len());
                bytes[at] = rng.random();
            }
            bytes.truncate(rng.random_range(1..=bytes.len()));
            server.raw(&bytes);
            continue;
        }
        let mut body = bodies[rng.random_range(0..bodies.len())]
            .as_bytes()
            .to_vec();
        if rng.random_bool(0.5) {
            let at = rng.random_range(0..body.len());
            body[at] = rng.random_range(32..127);
        }
        let body = String::from_utf8_lossy(&body).into_owned();
        let verb = ["GET", "POST", "PUT", "HEAD"][rng.random_range(0..4)];
        let answer = server.page(&format!("{verb} {path}"), &body);
        assert_ne!(answer.status, 500, "{verb} {path} {body}: {}", answer.text);
    }
    let answer = server.page("GET /api/documents/d1", "");
    assert_eq!(answer.status, 200, "{}", answer.text);
    assert!(answer.text.contains("\"kind\":\"completion\""));
}
