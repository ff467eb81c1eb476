//! The API by calling its router, without a socket.

use std::sync::Arc;

use axum::body::{Body, to_bytes};
use axum::http::{Request, StatusCode};
use edifice_studio::{Settings, Studio, router};
use serde_json::{Value, json};
use tower::ServiceExt;

/// A studio whose router is called.
pub(crate) struct Api {
    router: axum::Router,
    runtime: Option<tokio::runtime::Runtime>,
}

impl Api {
    /// Opens the files.
    pub(crate) fn new(settings: &Settings) -> Self {
        let studio = Arc::new(Studio::new(settings).expect("opens"));
        let runtime = tokio::runtime::Builder::new_current_thread();
        Self {
            router: router(studio),
            runtime: Some({ runtime }.enable_all().build().expect("runs")),
        }
    }

    /// The runtime of its requests.
    pub(crate) fn runtime(&self) -> &tokio::runtime::Runtime {
        self.runtime.as_ref().expect("until it is dropped")
    }

    /// Status and answer of a request.
    pub(crate) fn send(&self, verb: &str, path: &str, body: &Value) -> (StatusCode, Value) {
        let (status, bytes) = self.bytes(verb, path, body, "identity");
        let value = serde_json::from_slice(&bytes);
        let text = || Value::String(String::from_utf8_lossy(&bytes).into_owned());
        (status, value.unwrap_or_else(|_| text()))
    }

    /// Status and bytes of the answer to a request that accepts an encoding.
    pub(crate) fn bytes(
        &self,
        verb: &str,
        path: &str,
        body: &Value,
        encoding: &str,
    ) -> (StatusCode, Vec<u8>) {
        let body = if body.is_null() {
            Body::empty()
        } else {
            Body::from(body.to_string())
        };
        let request = Request::builder()
            .method(verb)
            .uri(path)
            .header("accept-encoding", encoding)
            .body(body)
            .expect("a request");
        self.runtime().block_on(async {
            let answer = self.router.clone().oneshot(request).await.expect("answers");
            let status = answer.status();
            let bytes = to_bytes(answer.into_body(), 1 << 26).await.expect("whole");
            (status, bytes.to_vec())
        })
    }

    /// The answer to a request that must succeed.
    pub(crate) fn get(&self, path: &str) -> Value {
        let (status, value) = self.send("GET", path, &Value::Null);
        assert_eq!(status, 200, "{path}: {value}");
        value
    }

    /// The same with a body; of a job, the document that it came to.
    pub(crate) fn post(&self, path: &str, body: Value) -> Value {
        let (status, value) = self.send("POST", path, &body);
        if status == 202 {
            let job = self.ended(&value["job"]);
            assert_eq!(job["state"], "done", "{path}: {job}");
            let id = job["document"].as_str().expect("a document");
            return self.get(&format!("/api/documents/{id}"));
        }
        assert_eq!(status, 200, "{path}: {value}");
        value
    }

    /// Waits for a job.
    pub(crate) fn ended(&self, job: &Value) -> Value {
        let path = format!("/api/jobs/{}", job["id"].as_str().expect("an id"));
        loop {
            let job = self.get(&path)["job"].clone();
            if job["state"] != "running" {
                return job;
            }
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
    }

    /// Edits a document as it is now.
    pub(crate) fn edit(&self, id: &str, commands: Value) -> Value {
        let revision = self.get(&format!("/api/documents/{id}"))["revision"].clone();
        let body = json!({"commands": commands, "revision": revision});
        self.post(&format!("/api/documents/{id}/edit"), body)
    }
}

impl Drop for Api {
    /// Work that was stopped and has not come to its next step is not waited for.
    fn drop(&mut self) {
        if let Some(runtime) = self.runtime.take() {
            runtime.shutdown_background();
        }
    }
}
