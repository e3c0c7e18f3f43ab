//! What XML asks of text.

use std::fmt::Write;

/// The text as it may stand in an attribute; characters that XML does not know are left out.
pub fn escaped(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            '\t' | '\n' | '\r' => {
                write!(out, "&#{};", c as u32).expect("a string takes all that is written")
            }
            '\u{0}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => {}
            _ => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_is_escaped_and_what_xml_does_not_know_is_left_out() {
        let text = escaped("a & <b> \"c\"\n\u{1}\u{ffff}ö");
        assert_eq!(text, "a &amp; &lt;b&gt; &quot;c&quot;&#10;ö");
    }
}
