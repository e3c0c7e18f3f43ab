//! The script and the style of the page, and what it may do: a page that is served asks for both, one in a file holds them
//! and runs nothing but what has their digests.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, PreEscaped, html};
use sha2::{Digest as _, Sha256};

const STYLE: &str = include_str!("style.css");

/// The parts of the script, in the order in which they need one another.
const SCRIPT: &str = concat!(
    "\"use strict\";\n",
    include_str!("script/keep.js"),
    include_str!("script/solids.js"),
    include_str!("script/stage.js"),
    include_str!("script/turn.js"),
    include_str!("script/pan.js"),
    include_str!("script/look.js"),
    include_str!("script/hands.js"),
    include_str!("script/controls.js"),
    include_str!("script/live.js"),
);

/// An asset of a page that is served: its media type and its text.
pub fn asset(name: &str) -> Option<(&'static str, &'static str)> {
    match name {
        "page.js" => Some(("text/javascript; charset=utf-8", SCRIPT)),
        "page.css" => Some(("text/css; charset=utf-8", STYLE)),
        _ => None,
    }
}

/// What stands in the head of a page.
pub fn head(is_live: bool) -> Markup {
    let digest = |text: &str| format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text)));
    html! {
        @if is_live {
            link rel="icon" href="data:,";
            link rel="stylesheet" href="/assets/page.css";
        } @else {
            meta http-equiv="Content-Security-Policy"
                content={ "default-src 'none'; img-src data:; script-src " (digest(SCRIPT)) "; style-src " (digest(STYLE)) };
            style { (PreEscaped(STYLE)) }
        }
    }
}

/// What stands at the end of a page.
pub fn tail(is_live: bool) -> Markup {
    html! {
        @if is_live { script src="/assets/page.js" {} }
        @else { script { (PreEscaped(SCRIPT)) } }
    }
}
