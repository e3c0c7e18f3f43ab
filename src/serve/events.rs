//! What the page is told while it is open: that a build has ended, and how one goes on. Whoever reads slowly is told of the
//! newest state only, so that nothing piles up.

use std::convert::Infallible;
use std::future::Future;
use std::pin::Pin;
use std::task::{Context, Poll, ready};
use std::time::Duration;

use hyper::body::{Body, Bytes, Frame};
use tokio::sync::watch;
use tokio::time::timeout;

/// So often something is said, whatever happens: whoever stands between takes a silent connection for a dead one.
const SILENCE: Duration = Duration::from_secs(15);

/// The newest state, numbered so that a listener sees which part of it is new.
#[derive(Clone, Debug, Default)]
struct Pulse {
    /// How many builds have been told of, and the last one as JSON.
    builds: u64,
    build: String,
    progress: String,
}

/// Tells listeners what happens. From any thread.
#[derive(Debug)]
pub struct Bell(watch::Sender<Pulse>);

/// Somebody who hears a [`Bell`].
#[derive(Debug)]
pub struct Listener(watch::Receiver<Pulse>);

impl Bell {
    /// A bell that has told of a build, as JSON on one line.
    pub fn new(build: String) -> Bell {
        let (builds, progress) = (1, String::new());
        let pulse = Pulse {
            builds,
            build,
            progress,
        };
        Bell(watch::Sender::new(pulse))
    }

    /// Tells of a build that has ended, as JSON on one line.
    pub fn build(&self, json: String) {
        self.0.send_modify(|pulse| {
            pulse.builds += 1;
            pulse.build = json;
            pulse.progress.clear();
        });
    }

    /// Tells how a build goes on, as JSON on one line.
    pub fn progress(&self, json: String) {
        self.0.send_modify(|pulse| pulse.progress = json);
    }

    /// One more listener.
    pub fn listen(&self) -> Listener {
        Listener(self.0.subscribe())
    }
}

/// A listener, how many builds it has told of, and what it says next.
type Said = (Listener, u64, Option<Bytes>);

/// The events of a listener as the body of a response.
pub struct Events(Pin<Box<dyn Future<Output = Said> + Send>>);

impl Events {
    /// All events from now on, and first the last build.
    pub fn of(listener: Listener) -> Events {
        Events(Box::pin(async move {
            let pulse = listener.0.borrow().clone();
            let (builds, text) = (pulse.builds, event("build", &pulse.build));
            let mut listener = listener;
            listener.0.mark_unchanged();
            (listener, builds, Some(text.into()))
        }))
    }
}

impl Body for Events {
    type Data = Bytes;
    type Error = Infallible;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, Infallible>>> {
        let (listener, builds, said) = ready!(self.0.as_mut().poll(context));
        match said {
            None => Poll::Ready(None),
            Some(text) => {
                self.0 = Box::pin(next(listener, builds));
                Poll::Ready(Some(Ok(Frame::data(text))))
            }
        }
    }
}

/// Waits for something to say, which is a comment where nothing happens.
async fn next(mut listener: Listener, builds: u64) -> Said {
    match timeout(SILENCE, listener.0.changed()).await {
        Err(_) => (listener, builds, Some(Bytes::from_static(b":\n\n"))),
        Ok(Err(_)) => (listener, builds, None),
        Ok(Ok(())) => {
            let pulse = listener.0.borrow_and_update().clone();
            let text = if pulse.builds == builds {
                event("progress", &pulse.progress)
            } else {
                event("build", &pulse.build)
            };
            (listener, pulse.builds, Some(text.into()))
        }
    }
}

fn event(name: &str, json: &str) -> String {
    format!("event: {name}\ndata: {json}\n\n")
}
