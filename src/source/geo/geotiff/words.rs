//! What is wrong with a TIFF, in words for those who have one: without the numbers and names of its format. Reading it is in
//! `file` and `blocks`.

use std::io::ErrorKind;

use tiff::tags::Tag;
use tiff::{TiffError, TiffFormatError};

/// What is wrong with a file.
pub(super) fn told(error: &TiffError) -> String {
    match error {
        TiffError::IoError(e) if e.kind() == ErrorKind::UnexpectedEof => {
            "it is truncated: the file ends within what it says of its images".into()
        }
        TiffError::IoError(e) if e.kind() == ErrorKind::Other => e.to_string(),
        TiffError::IoError(_) => "it is damaged, or truncated".into(),
        TiffError::LimitsExceeded | TiffError::IntSizeError => {
            "it is damaged: what it says of its image is longer than the file".into()
        }
        TiffError::FormatError(error) => misfit(error),
        TiffError::UnsupportedError(_) => {
            "it is of a kind of TIFF that is not read; write it with integers or floats of 8, 16, 32 or 64 bits, and with Deflate, LZW or no compression".into()
        }
        TiffError::UsageError(_) => damaged("what it says of its image contradicts itself"),
    }
}

fn damaged(how: &str) -> String {
    format!("it is damaged: {how}")
}

fn misfit(error: &TiffFormatError) -> String {
    use TiffFormatError as Error;
    match error {
        Error::TiffSignatureNotFound | Error::TiffSignatureInvalid => {
            "it is no TIFF, or truncated".into()
        }
        Error::ImageFileDirectoryNotFound => damaged("it does not say where its image begins"),
        Error::InconsistentSizesEncountered => {
            "it is damaged, or truncated: what it says of its image contradicts itself".into()
        }
        Error::InvalidDimensions(width, height) => {
            damaged(&format!("an image of {width} by {height} pixels"))
        }
        Error::RequiredTagNotFound(tag) => damaged(&format!("it does not say {}", named(*tag))),
        Error::InvalidTagValueType(tag) | Error::InvalidCountForTag(tag, _) => {
            damaged(&format!("what stands for {} cannot be that", named(*tag)))
        }
        Error::InvalidTag | Error::InvalidTypeForTag => {
            damaged("what it says of its image cannot be that")
        }
        Error::UnknownPredictor(number) => damaged(&format!("there is no predictor {number}")),
        Error::UnknownPlanarConfiguration(number) => {
            damaged(&format!("there is no order {number} of bands"))
        }
        Error::StripTileTagConflict => damaged("it says that it is in strips and in tiles"),
        Error::CycleInOffsets => damaged("its list of images leads back into itself"),
        Error::SamplesPerPixelIsZero => damaged("it has no bands"),
        Error::CompressedDataCorrupt(_) => damaged("its samples cannot be unpacked"),
        // Those that a later version of the reader may add.
        _ => damaged("what it says of its image cannot be"),
    }
}

/// What an entry of a file stands for.
fn named(tag: Tag) -> &'static str {
    match tag {
        Tag::ImageWidth => "how wide its image is",
        Tag::ImageLength => "how high its image is",
        Tag::BitsPerSample => "how many bits a sample has",
        Tag::SampleFormat => "whether its samples are integers or floats",
        Tag::SamplesPerPixel => "how many bands it has",
        Tag::Compression => "how it is compressed",
        Tag::Predictor => "how its samples are predicted",
        Tag::PlanarConfiguration => "in which order its bands are",
        Tag::PhotometricInterpretation => "what its samples mean",
        Tag::StripOffsets | Tag::TileOffsets => "where its blocks lie",
        Tag::StripByteCounts | Tag::TileByteCounts => "how long its blocks are",
        Tag::RowsPerStrip => "how high its strips are",
        Tag::TileWidth | Tag::TileLength => "how large its tiles are",
        Tag::Unknown(33550 | 33922 | 34264) => "where it lies",
        Tag::Unknown(34735..=34737) => "which coordinate system it has",
        _ => "something of its image",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bug: the names of tags and of lists of them stood in messages as the format calls them.
    #[test]
    fn no_words_of_the_format_are_told() {
        let errors = [
            TiffFormatError::RequiredTagNotFound(Tag::StripOffsets),
            TiffFormatError::InvalidTagValueType(Tag::Unknown(33550)),
            TiffFormatError::InvalidCountForTag(Tag::TileByteCounts, 7),
            TiffFormatError::RequiredTagNotFound(Tag::Unknown(65000)),
            TiffFormatError::InvalidTypeForTag,
            TiffFormatError::ImageFileDirectoryNotFound,
            TiffFormatError::StripTileTagConflict,
            TiffFormatError::CycleInOffsets,
        ];
        for error in errors {
            let said = told(&TiffError::FormatError(error));
            let is_plain = |word: &str| !said.contains(word);
            let words = [
                "IFD", "ag ", "tag", "`", "Offsets", "Counts", "Unknown", "33550",
            ];
            assert!(words.into_iter().all(is_plain), "{said}");
        }
        let missing = TiffFormatError::RequiredTagNotFound(Tag::ImageWidth);
        assert_eq!(
            told(&TiffError::FormatError(missing)),
            "it is damaged: it does not say how wide its image is"
        );
    }
}
