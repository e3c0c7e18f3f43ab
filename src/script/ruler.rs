//! `text_width`: how wide a text is, for expressions. Fonts and their files are known to a [`Ruler`], which
//! the room that reads the spec brings along.

use std::sync::Arc;

use starlark::environment::GlobalsBuilder;
use starlark::eval::Evaluator;
use starlark::starlark_module;
use starlark::values::Value;
use starlark::values::float::UnpackFloat;

use crate::session::{refuse, session};
use fretwork_diagnostic::nearest;

/// How a text is set; what is left out is as the ruler takes it to be.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lettering {
    /// The height of the em square.
    pub size: Option<f64>,
    /// The path of the font as written; none inside for the plain letters without a font.
    pub font: Option<Option<Arc<str>>>,
    /// What is put between any two letters.
    pub letter_spacing: Option<f64>,
}

/// What measures text.
pub trait Ruler: Send + Sync {
    /// The width of the longest line of `text`, in the unit of the file.
    ///
    /// # Errors
    /// A sentence that says why it has none.
    fn width(&self, text: &str, lettering: &Lettering) -> Result<f64, String>;
}

/// The ruler of an evaluation, as its session keeps it.
pub(crate) struct Held(pub(crate) Arc<dyn Ruler>);

/// What one measuring counts for, in elements, and every byte of its text: a font is read anew each time, which
/// takes about a millisecond, so that an expression may measure a few hundred texts.
const SET: usize = 4000;
/// See [`SET`].
const LETTER: usize = 64;

/// The names of the arguments after the text, in their order.
const ARGUMENTS: [&str; 3] = ["size", "font", "letter_spacing"];

/// Puts `text_width` among the globals.
#[starlark_module]
pub(crate) fn register(builder: &mut GlobalsBuilder) {
    fn text_width<'v>(
        #[starlark(require = pos)] text: &str,
        #[starlark(args)] given: starlark::values::tuple::UnpackTuple<Value<'v>>,
        #[starlark(kwargs)] named: starlark::collections::SmallMap<String, Value<'v>>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<f64> {
        if given.items.len() > ARGUMENTS.len() {
            return Err(refuse(
                "`text_width` takes a text and at most `size`, `font` and `letter_spacing`",
            ));
        }
        let mut lettering = Lettering::default();
        let in_order = ARGUMENTS.iter().copied().zip(given.items.iter().copied());
        let by_name = named.iter().map(|(name, value)| (name.as_str(), *value));
        for (name, value) in in_order.chain(by_name) {
            take(&mut lettering, name, value)?;
        }
        let session = session(eval);
        session.charge(SET + LETTER * text.len())?;
        let Some(ruler) = session.job::<Held>() else {
            return Err(refuse("text cannot be measured here"));
        };
        ruler.0.width(text, &lettering).map_err(refuse)
    }
}

/// Reads the argument `name`.
fn take(lettering: &mut Lettering, name: &str, value: Value<'_>) -> starlark::Result<()> {
    let number = || {
        use starlark::values::UnpackValue as _;
        let number = UnpackFloat::unpack_value(value).ok().flatten();
        let message = format!("`{name}` of `text_width` is a number");
        number.map(|n| n.0).ok_or_else(|| refuse(message))
    };
    let twice = || refuse(format!("`text_width` is given `{name}` twice"));
    match name {
        "size" => {
            let size = number()?;
            if !(size > 0.0 && size.is_finite()) {
                return Err(refuse("`size` of `text_width` is above 0"));
            }
            lettering
                .size
                .replace(size)
                .map_or(Ok(()), |_| Err(twice()))
        }
        "letter_spacing" => {
            let spacing = number()?;
            let before = lettering.letter_spacing.replace(spacing);
            before.map_or(Ok(()), |_| Err(twice()))
        }
        "font" => {
            let font = match value.unpack_str() {
                Some(path) => Some(Arc::from(path)),
                None if value.is_none() => None,
                None => {
                    return Err(refuse(
                        "`font` of `text_width` is the path of a font, or None for plain letters",
                    ));
                }
            };
            lettering
                .font
                .replace(font)
                .map_or(Ok(()), |_| Err(twice()))
        }
        unknown => {
            let near = nearest(unknown, ARGUMENTS)
                .map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            Err(refuse(format!(
                "`text_width` has no argument `{unknown}`{near}"
            )))
        }
    }
}
