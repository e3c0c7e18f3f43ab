//! What `text_width` of expressions measures with: the fonts of the project, which become inputs of what
//! names them. The letters of the entry that an expression stands in are read in `lettering`, and how letters look
//! is known to `source`.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use super::database::Db;
use fretwork_action::resolve;
use fretwork_geometry::letters;
use fretwork_script::{ExpressionError, Lettering, Ruler, Value, evaluate_with};
use fretwork_source::font;

/// The size of letters where neither an expression nor its entry says one; the language's own.
const SIZE: f64 = 10.0;

/// The most fonts of one value: for each, its expression is evaluated once more.
const MOST: usize = 16;

/// The letters of an entry, in the unit of its file.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnLetters {
    /// The height of the em square.
    pub size: f64,
    /// The path of the font as written.
    pub font: Option<Arc<str>>,
    /// What is put between any two letters.
    pub letter_spacing: f64,
}

impl Default for OwnLetters {
    fn default() -> OwnLetters {
        OwnLetters {
            size: SIZE,
            font: None,
            letter_spacing: 0.0,
        }
    }
}

/// The fonts that the expressions of one text have named so far.
pub struct Fonts<'a> {
    db: &'a dyn Db,
    /// The file that the expressions stand in.
    file: &'a Arc<str>,
    own: OwnLetters,
    read: BTreeMap<Arc<str>, Result<Arc<[u8]>, String>>,
}

impl<'a> Fonts<'a> {
    /// None read yet.
    pub fn new(db: &'a dyn Db, file: &'a Arc<str>, own: OwnLetters) -> Fonts<'a> {
        Fonts {
            db,
            file,
            own,
            read: BTreeMap::new(),
        }
    }

    /// The value of an expression. Where it names a font that was not read, the font is read and the
    /// expression is evaluated again.
    ///
    /// # Errors
    /// What is wrong with the expression, a font that cannot be read, a letter that it lacks.
    pub fn evaluate(
        &mut self,
        text: &str,
        values: &BTreeMap<Arc<str>, Value>,
    ) -> Result<Value, ExpressionError> {
        loop {
            let measure = Arc::new(Measure {
                own: self.own.clone(),
                read: self.read.clone(),
                missing: Mutex::default(),
            });
            let ruler: Arc<dyn Ruler> = measure.clone();
            let value = evaluate_with(text, values, &ruler);
            let missing = measure.missing.lock().expect(UNPOISONED).take();
            match missing {
                Some(path) => {
                    let font = self.font(&path);
                    self.read.insert(path, font);
                }
                None => return value,
            }
        }
    }

    /// The bytes of the font at a path below the folder of the file.
    fn font(&self, path: &str) -> Result<Arc<[u8]>, String> {
        if self.read.len() >= MOST {
            return Err(format!("one value may measure with {MOST} fonts"));
        }
        let outside = || format!("`{path}` is outside of the project");
        let resolved = resolve(self.file, path).ok_or_else(outside)?;
        let content = self.db.file(&resolved).content(self.db);
        let bytes = content.clone().and_then(|content| content.whole());
        bytes.map_err(|error| format!("cannot read `{path}`: {error}"))
    }
}

const UNPOISONED: &str = "no code panics while it holds the missing font";

/// The ruler of one evaluation, which holds what it needs itself.
struct Measure {
    own: OwnLetters,
    read: BTreeMap<Arc<str>, Result<Arc<[u8]>, String>>,
    /// A font that was named and is not among those.
    missing: Mutex<Option<Arc<str>>>,
}

impl Ruler for Measure {
    fn width(&self, text: &str, lettering: &Lettering) -> Result<f64, String> {
        let size = lettering.size.unwrap_or(self.own.size);
        let spacing = lettering.letter_spacing.unwrap_or(self.own.letter_spacing);
        let font = lettering.font.as_ref().unwrap_or(&self.own.font);
        let widths = match font {
            None => plain(text, size)?,
            Some(path) => match self.read.get(path) {
                Some(font) => set(font.as_ref()?, text, size)?,
                None => {
                    *self.missing.lock().expect(UNPOISONED) = Some(path.clone());
                    return Err(format!("`{path}` is not read yet"));
                }
            },
        };
        let spaced =
            |(width, count): (f64, usize)| width + spacing * count.saturating_sub(1) as f64;
        Ok(widths.into_iter().map(spaced).fold(0.0, f64::max))
    }
}

/// Width and number of letters of each line of plain letters, with half a stroke on either side.
fn plain(text: &str, size: f64) -> Result<Vec<(f64, usize)>, String> {
    let line = |text: &str| {
        let letters = letters::line(text, size).map_err(|e| e.to_string())?;
        let stroke = letters::WEIGHT * size;
        let width = letters
            .last()
            .map_or(0.0, |last| last.at + last.width + stroke);
        Ok((width, letters.len()))
    };
    text.lines().map(line).collect()
}

/// Width and number of letters of each line in a font.
fn set(font: &[u8], text: &str, size: f64) -> Result<Vec<(f64, usize)>, String> {
    // Outlines are not looked at, so that they may be as coarse as can be.
    let set = font::set(font, text, size, size).map_err(|e| e.to_string())?;
    let lines = set.lines.iter();
    Ok(lines.map(|line| (line.width, line.glyphs.len())).collect())
}
