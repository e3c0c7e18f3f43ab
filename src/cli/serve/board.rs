//! What stands between the server and the build: what was published last, and what is wanted next. Neither waits for the
//! other.

use std::sync::{Arc, Mutex, PoisonError};

use serde_json::json;

use super::super::exhibit::Finding;
use super::super::page;
use super::shown::Shown;
use super::state;
use super::wish::{Wish, Wishes};
use fretwork_engine::Stop;
use fretwork_serve::{Answer, Bell, Listener, Piece, Site, Verdict};

/// The place where both meet.
pub struct Board {
    shown: Mutex<Arc<Shown>>,
    wanted: Mutex<Wanted>,
    bell: Bell,
    wake: Box<dyn Fn() + Send + Sync>,
}

#[derive(Default)]
struct Wanted {
    wishes: Wishes,
    /// The number of the build that was begun last.
    begun: u64,
    /// Whether a build is to begin.
    is_new: bool,
    /// What gives up the build that is going on.
    stop: Stop,
}

impl Board {
    /// A board on which nothing stands yet. `wake` is called, by any thread, when there is something to build.
    pub fn new(wake: impl Fn() + Send + Sync + 'static) -> Board {
        let shown = Shown::default();
        Board {
            bell: Bell::new(shown.event()),
            shown: Mutex::new(Arc::new(shown)),
            wanted: Mutex::default(),
            wake: Box::new(wake),
        }
    }

    /// A build begins, which `stop` gives up: what is wanted, and the number of the build.
    pub fn begin(&self, stop: Stop) -> (Wishes, u64) {
        self.change(|wanted| {
            stop.clear();
            wanted.stop = stop;
            wanted.is_new = false;
            wanted.begun += 1;
            (wanted.wishes.clone(), wanted.begun)
        })
    }

    /// The build is not to be given up any more: from here on it is written and shown.
    pub fn end(&self) {
        self.change(|wanted| {
            wanted.stop.clear();
            wanted.stop = Stop::default();
        });
    }

    /// Goes on with the build that was begun last, which `stop` gives up; not if another one is wanted.
    pub fn resume(&self, stop: Stop) -> bool {
        self.change(|wanted| {
            wanted.stop = stop;
            !wanted.is_new
        })
    }

    /// Whether something is wanted that no build has begun with.
    pub fn is_wanted(&self) -> bool {
        self.change(|wanted| wanted.is_new)
    }

    /// A file has changed: the build that is going on is of no use any more.
    pub fn overtake(&self) {
        self.change(|wanted| wanted.stop.set());
    }

    /// Shows a build from now on. Of what is wanted, names that `keep` does not hold for are forgotten.
    pub fn publish(&self, shown: Shown, keep: impl Fn(&Wishes) -> Wishes) {
        self.change(|wanted| wanted.wishes = keep(&wanted.wishes));
        let event = shown.event();
        *self.shown.lock().unwrap_or_else(PoisonError::into_inner) = Arc::new(shown);
        self.bell.build(event);
    }

    /// What is shown.
    pub fn shown(&self) -> Arc<Shown> {
        let shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        shown.clone()
    }

    /// Tells how a build goes on.
    pub fn tell(&self, progress: String) {
        self.bell.progress(progress);
    }

    fn change<T>(&self, change: impl FnOnce(&mut Wanted) -> T) -> T {
        change(&mut self.wanted.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Notes what is wanted, unless it is refused; the number of the first build that shows it.
    fn wish(&self, wish: &Wish) -> Result<u64, Vec<Finding>> {
        let shown = self.shown();
        let number = self.change(|wanted| {
            let wishes = wanted.wishes.with(wish);
            let refused = shown.refusals(&wish.spec, &wishes);
            if !refused.is_empty() {
                return Err(refused);
            }
            if wanted.wishes == wishes && !wanted.is_new {
                // The build that goes on, or was the last, shows it.
                return Ok((wanted.begun, false));
            }
            let is_first = !wanted.is_new;
            wanted.wishes = wishes;
            wanted.is_new = true;
            wanted.stop.set();
            Ok((wanted.begun + 1, is_first))
        });
        number.map(|(number, wakes)| {
            if wakes {
                (self.wake)();
            }
            number
        })
    }
}

impl Site for Board {
    fn page(&self) -> Arc<[u8]> {
        self.shown().page()
    }

    fn asset(&self, name: &str) -> Option<Piece> {
        page::asset(name).map(|(media, text)| Piece {
            media,
            bytes: text.as_bytes().into(),
        })
    }

    fn state(&self) -> Arc<[u8]> {
        self.shown().state()
    }

    fn file(&self, path: &str, digest: Option<&str>, view: Option<&str>) -> Option<Piece> {
        self.shown().file(path, digest, view)
    }

    fn set(&self, body: &[u8]) -> Answer {
        let (verdict, json) = match serde_json::from_slice::<Wish>(body) {
            Err(error) => (Verdict::Malformed, json!({ "error": error.to_string() })),
            Ok(wish) => match self.wish(&wish) {
                Ok(build) => (Verdict::Taken, json!({ "build": build })),
                Err(found) => (
                    Verdict::Refused,
                    json!({ "diagnostics": state::findings(&found) }),
                ),
            },
        };
        Answer {
            verdict,
            json: json.to_string(),
        }
    }

    fn listen(&self) -> Listener {
        self.bell.listen()
    }
}
