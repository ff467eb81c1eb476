//! The server on this machine's own address.

use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;

use super::guard::{Guard, guard};
use super::{Settings, Studio, router};
use edifice_base::{Error, Result};

/// A studio that listens, before it answers.
pub struct Running {
    listener: TcpListener,
    app: Router,
    head: Duration,
    address: String,
    studio: Arc<Studio>,
}

/// Opens the files and listens on the loopback address only.
///
/// # Errors
/// A file that cannot be opened, a port that is taken, no randomness for the token.
pub fn start(settings: &Settings) -> Result<Running> {
    let studio = Arc::new(Studio::new(settings)?);
    let at = SocketAddr::from((Ipv4Addr::LOCALHOST, settings.port));
    let name = at.to_string();
    let fail = |action| move |e| Error::io(Path::new(&name), action, e);
    let listener = TcpListener::bind(at).map_err(fail("listen on"))?;
    listener.set_nonblocking(true).map_err(Error::method)?;
    let port = listener.local_addr().map_err(Error::method)?.port();
    let token = token()?;
    Ok(Running {
        app: guarded(
            router(studio.clone()),
            Guard::new(port, token.clone(), settings.limits),
        ),
        head: settings.limits.head,
        address: format!("http://127.0.0.1:{port}/#token={token}"),
        listener,
        studio,
    })
}

/// Answers connections. One on which the head of a request does not come in this time is closed, whether it comes slowly or not
/// at all.
async fn connections(
    listener: tokio::net::TcpListener,
    app: Router,
    head: Duration,
) -> std::convert::Infallible {
    let mut http = http1::Builder::new();
    http.timer(TokioTimer::new()).header_read_timeout(head);
    loop {
        let Ok((stream, _)) = listener.accept().await else {
            // A client that is gone, or too many open files: there is room again later.
            tokio::time::sleep(Duration::from_millis(50)).await;
            continue;
        };
        let service = TowerToHyperService::new(app.clone());
        let connection = http.serve_connection(TokioIo::new(stream), service);
        tokio::spawn(async move {
            // A client that broke off is told nothing.
            let _ = connection.await;
        });
    }
}

/// The routes behind the guard: the outer router has none of its own, so that nothing is routed before.
fn guarded(routes: Router, who: Guard) -> Router {
    let checked = axum::middleware::from_fn_with_state(who, guard);
    Router::new().fallback_service(routes).layer(checked)
}

/// 128 bits from the operating system, which no seed decides.
fn token() -> Result<String> {
    super::private::random_name(16)
}

impl Running {
    /// The address with its token.
    pub fn address(&self) -> &str {
        &self.address
    }

    /// Answers until `end` comes.
    ///
    /// # Errors
    /// When the system stops the server.
    pub fn serve(self, end: impl Future<Output = ()> + Send + 'static) -> Result<()> {
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(2)
            .enable_all()
            .build()
            .map_err(Error::method)?;
        let served = runtime.block_on(async {
            let listener = tokio::net::TcpListener::from_std(self.listener)?;
            // An open connection, or an edit that still runs, does not hold up the end.
            tokio::select! {
                never = connections(listener, self.app, self.head) => match never {},
                () = end => Ok::<_, std::io::Error>(()),
            }
        });
        runtime.shutdown_background();
        self.studio.end();
        served.map_err(Error::method)
    }

    /// Number of documents with unsaved work of studios that ended, which the page offers.
    pub fn count_offered(&self) -> usize {
        self.studio.count_offered()
    }

    /// Answers until Ctrl-C. With unsaved work `ask` is then called with the names of the documents: true ends the studio, false
    /// goes on, and another Ctrl-C before the answer ends it. What is unsaved stays in the journals in any case.
    ///
    /// # Errors
    /// As [`Self::serve`].
    pub fn serve_until_interrupted(
        self,
        ask: impl Fn(&[String]) -> bool + Send + Sync + 'static,
    ) -> Result<()> {
        let studio = self.studio.clone();
        let ask = Arc::new(ask);
        self.serve(async move {
            loop {
                // Without the signal there is nothing to wait for but the system ending the process.
                if tokio::signal::ctrl_c().await.is_err() {
                    std::future::pending::<()>().await;
                }
                let (studio, ask) = (studio.clone(), ask.clone());
                // Others may hold a document while it works: the server's own threads do not wait for it.
                let asked = tokio::task::spawn_blocking(move || {
                    let names = studio.unsaved();
                    names.is_empty() || ask(&names)
                });
                let ends = tokio::select! {
                    answer = asked => answer.unwrap_or(true),
                    again = tokio::signal::ctrl_c() => again.is_ok(),
                };
                if ends {
                    return;
                }
            }
        })
    }
}
