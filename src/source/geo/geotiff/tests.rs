//! GeoTIFFs that are written here, field by field, good and bad.

use std::sync::Arc;

use super::{GeoTiff, GeoTiffError};
use fretwork_geometry::{Affine, Point, Samples as _};

fn open(bytes: &Arc<[u8]>, band: u64) -> Result<GeoTiff, GeoTiffError> {
    super::open(std::io::Cursor::new(bytes.clone()), band)
}

/// A file of one image of uncompressed strips, a strip a row.
#[derive(Clone)]
struct Tiff {
    big_endian: bool,
    big: bool,
    /// Tag, type, and values as numbers or, for text and doubles, as bytes.
    fields: Vec<(u16, Field)>,
    rows: Vec<Vec<u8>>,
}

#[derive(Clone)]
enum Field {
    Short(Vec<u16>),
    Long(Vec<u32>),
    Double(Vec<f64>),
    Text(&'static str),
}

impl Tiff {
    /// Heights 0, 1, … of 16 bits, row by row.
    fn new(width: u16, height: u16) -> Tiff {
        let value = |i: u16, j: u16| (j * width + i).to_le_bytes();
        Tiff {
            big_endian: false,
            big: false,
            fields: vec![
                (256, Field::Long(vec![width.into()])),
                (257, Field::Long(vec![height.into()])),
                (258, Field::Short(vec![16])),
                (259, Field::Short(vec![1])),
                (262, Field::Short(vec![1])),
                (277, Field::Short(vec![1])),
                (278, Field::Long(vec![1])),
                (339, Field::Short(vec![2])),
            ],
            rows: (0..height)
                .map(|j| (0..width).flat_map(|i| value(i, j)).collect())
                .collect(),
        }
    }

    fn with(mut self, tag: u16, field: Field) -> Tiff {
        self.fields.retain(|(known, _)| *known != tag);
        self.fields.push((tag, field));
        self
    }

    fn placed(self) -> Tiff {
        self.with(33550, Field::Double(vec![10.0, 20.0, 0.0])).with(
            33922,
            Field::Double(vec![0.0, 0.0, 0.0, 1000.0, 5000.0, 0.0]),
        )
    }

    fn number(&self, value: u64, size: usize) -> Vec<u8> {
        let bytes = value.to_le_bytes();
        let mut bytes = bytes[..size].to_vec();
        if self.big_endian {
            bytes.reverse();
        }
        bytes
    }

    fn bytes(&self) -> Arc<[u8]> {
        let order = if self.big_endian { b"MM" } else { b"II" };
        let (word, head) = if self.big { (8, 16) } else { (4, 8) };
        let mut out = order.to_vec();
        out.extend(self.number(if self.big { 43 } else { 42 }, 2));
        if self.big {
            out.extend(self.number(8, 2));
            out.extend(self.number(0, 2));
        }
        out.resize(head, 0);
        let mut offsets = Vec::new();
        for row in &self.rows {
            offsets.push(out.len() as u32);
            for pair in row.chunks(2) {
                out.extend(pair.iter().rev().filter(|_| self.big_endian));
                out.extend(pair.iter().filter(|_| !self.big_endian));
            }
        }
        let counts = self.rows.iter().map(|row| row.len() as u32).collect();
        let mut fields = self.fields.clone();
        let known = |tag| self.fields.iter().any(|(own, _)| *own == tag);
        if !known(273) {
            fields.push((273, Field::Long(offsets)));
        }
        if !known(279) {
            fields.push((279, Field::Long(counts)));
        }
        fields.sort_by_key(|(tag, _)| *tag);
        let mut entries = Vec::new();
        for (tag, field) in &fields {
            let (kind, count, content): (u64, usize, Vec<u8>) = match field {
                Field::Short(v) => (
                    3,
                    v.len(),
                    v.iter().flat_map(|n| self.number((*n).into(), 2)).collect(),
                ),
                Field::Long(v) => (
                    4,
                    v.len(),
                    v.iter().flat_map(|n| self.number((*n).into(), 4)).collect(),
                ),
                Field::Double(v) => (
                    12,
                    v.len(),
                    v.iter().flat_map(|n| self.number(n.to_bits(), 8)).collect(),
                ),
                Field::Text(text) => (2, text.len() + 1, [text.as_bytes(), b"\0"].concat()),
            };
            let mut value = content.clone();
            if content.len() > word {
                value = self.number(out.len() as u64, word);
                out.extend(content);
            }
            value.resize(word, 0);
            entries.extend(self.number((*tag).into(), 2));
            entries.extend(self.number(kind, 2));
            entries.extend(self.number(count as u64, word));
            entries.extend(value);
        }
        let at = self.number(out.len() as u64, word);
        out[head - word..head].copy_from_slice(&at);
        out.extend(self.number(fields.len() as u64, if self.big { 8 } else { 2 }));
        out.extend(entries);
        out.extend(self.number(0, word));
        out.into()
    }

    fn open(&self) -> Result<GeoTiff, GeoTiffError> {
        open(&self.bytes(), 1)
    }

    fn error(&self) -> String {
        self.open().map(|_| ()).unwrap_err().to_string()
    }
}

fn all(raster: &GeoTiff) -> Vec<f64> {
    let [width, height] = raster.blocks.size();
    (0..width * height)
        .map(|k| raster.blocks.sample(k % width, k / width))
        .collect()
}

#[test]
fn either_byte_order_and_size_of_offsets_gives_the_same_samples() {
    let expected: Vec<f64> = (0..6).map(f64::from).collect();
    for (big_endian, big) in [(false, false), (true, false), (false, true), (true, true)] {
        let file = Tiff {
            big_endian,
            big,
            ..Tiff::new(3, 2).placed()
        };
        let raster = file.open().unwrap();
        assert_eq!(all(&raster), expected);
        assert_eq!(raster.blocks.fault(), None);
        assert_eq!(
            raster.frame,
            Some(Affine([10.0, 0.0, 0.0, -20.0, 1000.0, 5000.0]))
        );
        assert!(raster.crs.is_none());
    }
}

#[test]
fn tags_say_where_a_raster_lies() {
    let frame = |tiff: &Tiff| tiff.open().unwrap().frame;
    assert_eq!(frame(&Tiff::new(2, 2)), None);
    let point = Field::Short(vec![1, 1, 0, 1, 1025, 0, 1, 2]);
    let point = frame(&Tiff::new(2, 2).placed().with(34735, point)).unwrap();
    assert_eq!(
        point.apply(Point::new(0.5, 0.5)),
        Point::new(1000.0, 5000.0)
    );
    let matrix = vec![
        3.0, 4.0, 0.0, 100.0, 5.0, -6.0, 0.0, 200.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0,
    ];
    let turned = frame(&Tiff::new(2, 2).with(34264, Field::Double(matrix))).unwrap();
    assert_eq!(turned.apply(Point::new(1.0, 2.0)), Point::new(111.0, 193.0));
    let ties = Field::Double(vec![0.0; 12]);
    let error = Tiff::new(2, 2).with(33922, ties).error();
    assert!(error.contains("control points"), "{error}");
}

#[test]
fn keys_say_in_which_system() {
    let crs = |keys: Vec<u16>| {
        let mut directory = vec![1, 1, 0, keys.len() as u16 / 2];
        directory.extend(keys.chunks(2).flat_map(|k| [k[0], 0, 1, k[1]]));
        Tiff::new(2, 2)
            .with(34735, Field::Short(directory))
            .open()
            .map(|raster| raster.crs)
    };
    let utm = crs(vec![1024, 1, 3072, 32616]).unwrap().unwrap();
    assert_eq!(utm.epsg(), Some(32616));
    assert!(
        crs(vec![1024, 2, 2048, 4326])
            .unwrap()
            .unwrap()
            .is_geographic()
    );
    assert!(crs(vec![1024, 1, 3072, 50_000]).is_err());
    let contradiction = crs(vec![1024, 1, 3072, 4326]).unwrap_err().to_string();
    assert!(contradiction.contains("contradicts"), "{contradiction}");
    // By parameters: the same zone.
    let directory = vec![
        1, 1, 0, 8, 1024, 0, 1, 1, 3072, 0, 1, 32767, 3074, 0, 1, 32767, 3075, 0, 1, 1, 2048, 0, 1,
        4326, 3080, 34736, 1, 0, 3082, 34736, 1, 1, 3092, 34736, 1, 2,
    ];
    let by_hand = Tiff::new(2, 2)
        .with(34735, Field::Short(directory))
        .with(34736, Field::Double(vec![-87.0, 500_000.0, 0.9996]));
    assert!(by_hand.open().unwrap().crs.unwrap().is_same(&utm));
}

#[test]
fn samples_that_stand_for_nothing_have_no_value_and_others_are_scaled() {
    let metadata = "<GDALMetadata><Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.5</Item><Item name=\"OFFSET\" sample=\"0\" role=\"offset\">100</Item></GDALMetadata>";
    let raster = Tiff::new(2, 2)
        .with(42113, Field::Text("2 "))
        .with(42112, Field::Text(metadata))
        .open()
        .unwrap();
    let values = all(&raster);
    assert_eq!(values[..2], [100.0, 100.5]);
    assert!(values[2].is_nan());
    assert_eq!(values[3], 101.5);
}

#[test]
fn files_that_cannot_be_read_say_why() {
    let whole = Tiff::new(4, 3).bytes();
    for cut in 0..whole.len() {
        assert!(open(&whole[..cut].into(), 1).is_err(), "{cut}");
    }
    assert!(open(&whole, 0).is_err());
    assert!(matches!(
        open(&whole, 2),
        Err(GeoTiffError::Band { band: 2, count: 1 })
    ));
    let error = Tiff::new(2, 2).with(259, Field::Short(vec![50000])).error();
    assert!(error.contains("ZSTD"), "{error}");
    let error = Tiff::new(2, 2)
        .with(273, Field::Long(vec![8, 90_000]))
        .error();
    assert!(error.contains("truncated"), "{error}");
    let error = Tiff::new(2, 2).with(254, Field::Long(vec![1])).error();
    assert!(error.contains("no image of full size"), "{error}");
}

#[test]
fn a_file_that_claims_more_than_it_holds_is_refused_before_anything_is_set_aside() {
    let giant = Tiff::new(2, 2)
        .with(256, Field::Long(vec![1 << 31]))
        .with(257, Field::Long(vec![1 << 31]));
    assert!(giant.open().is_err());
    // A row that is longer than its bytes is a fault of the block, found when it is read.
    let wide = Tiff::new(2, 2).with(256, Field::Long(vec![100]));
    if let Ok(raster) = wide.open() {
        assert!(raster.blocks.sample(50, 0).is_nan());
        assert!(raster.blocks.fault().unwrap().contains("block 0"));
    }
    // One strip of 2^32 rows, as a list of whose parts there is no memory.
    for width in [1, u32::MAX] {
        let strip = Tiff::new(2, 1)
            .with(256, Field::Long(vec![width]))
            .with(257, Field::Long(vec![u32::MAX]))
            .with(278, Field::Long(vec![u32::MAX]));
        let raster = strip.placed().open().unwrap();
        assert!(raster.blocks.held_bytes() < 100);
        assert!(raster.blocks.sample(0, 1 << 31).is_nan());
        let fault = raster.blocks.fault().unwrap();
        assert!(fault.contains("fewer samples"), "{fault}");
    }
    // Blocks that share their bytes.
    let shared = Tiff::new(2, 200).with(273, Field::Long(vec![8; 200]));
    let same = shared.with(279, Field::Long(vec![700; 200]));
    assert!(
        same.error().contains("over one another"),
        "{}",
        same.error()
    );
}

/// A row of pixels with bands of one byte each, packed by Deflate, as one strip.
fn deflated(pixels: &[&[u8]]) -> Tiff {
    let bytes = pixels.concat();
    let mut packer = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    std::io::Write::write_all(&mut packer, &bytes).unwrap();
    Tiff {
        rows: vec![packer.finish().unwrap()],
        ..Tiff::new(pixels.len() as u16, 1)
    }
    .with(258, Field::Short(vec![8; pixels[0].len()]))
    .with(259, Field::Short(vec![8]))
    .with(277, Field::Short(vec![pixels[0].len() as u16]))
    .with(339, Field::Short(vec![1; pixels[0].len()]))
}

#[test]
fn bands_beyond_the_colours_have_their_own_samples() {
    let pixels: [&[u8]; 2] = [&[1, 2, 3, 4, 5], &[11, 12, 13, 14, 15]];
    for (photometric, extra) in [(2, vec![0, 0]), (1, vec![0; 4]), (2, vec![2, 0])] {
        let file = deflated(&pixels)
            .with(262, Field::Short(vec![photometric]))
            .with(338, Field::Short(extra));
        for band in 1..=5 {
            let raster = open(&file.bytes(), band).unwrap();
            let first = band as f64;
            assert_eq!(all(&raster), [first, first + 10.0], "band {band}");
        }
    }
}

#[test]
fn samples_are_numbers_whatever_colours_they_mean() {
    let file = deflated(&[&[0], &[200]]);
    // White is zero; numbers in a palette.
    for photometric in [0, 3] {
        let file = file.clone().with(262, Field::Short(vec![photometric]));
        assert_eq!(all(&file.open().unwrap()), [0.0, 200.0]);
    }
    for (bits, format, name) in [
        (1, 1, "1 bits"),
        (12, 1, "12 bits"),
        (24, 3, "floats of 24"),
        (64, 6, "complex"),
    ] {
        let odd = Tiff::new(2, 2)
            .with(258, Field::Short(vec![bits]))
            .with(339, Field::Short(vec![format]));
        assert!(odd.error().contains(name), "{}", odd.error());
    }
}

#[test]
fn a_block_that_unpacks_beyond_its_size_is_a_fault() {
    let pixel: &[u8] = &[0];
    let mut bomb = deflated(&vec![pixel; 60_000]);
    bomb = bomb.with(256, Field::Long(vec![20]));
    let raster = bomb.open().unwrap();
    assert!(raster.blocks.sample(0, 0).is_nan());
    let fault = raster.blocks.fault().unwrap();
    assert!(fault.contains("more than the samples"), "{fault}");
    // The last strip may be packed as long as the others.
    let padded = deflated(&[&[1], &[2], &[3], &[4]])
        .with(256, Field::Long(vec![1]))
        .with(257, Field::Long(vec![7]))
        .with(278, Field::Long(vec![4]));
    let strip = padded.rows[0].clone();
    let padded = Tiff {
        rows: vec![strip; 2],
        ..padded
    };
    let raster = padded.open().unwrap();
    assert_eq!(all(&raster), [1.0, 2.0, 3.0, 4.0, 1.0, 2.0, 3.0]);
    assert_eq!(raster.blocks.fault(), None);
}

/// What another implementation packs is unpacked to the same samples.
#[test]
fn samples_packed_elsewhere_come_back() {
    use tiff::encoder::{Compression, DeflateLevel, Predictor, TiffEncoder, colortype};
    let (width, height) = (67, 41);
    let wave = |k: usize| (k * k % 251) as f64 - 40.0;
    let packings = [
        Compression::Uncompressed,
        Compression::Lzw,
        Compression::Packbits,
        Compression::Deflate(DeflateLevel::Balanced),
    ];
    for (number, compression) in packings.into_iter().enumerate() {
        for predictor in [Predictor::None, Predictor::Horizontal] {
            macro_rules! check {
                ($color:ident, $sample:ty) => {{
                    let samples: Vec<$sample> =
                        (0..width * height).map(|k| wave(k) as $sample).collect();
                    let mut file = std::io::Cursor::new(Vec::new());
                    TiffEncoder::new(&mut file)
                        .unwrap()
                        .with_compression(compression)
                        .with_predictor(predictor)
                        .write_image::<colortype::$color>(width as u32, height as u32, &samples)
                        .unwrap();
                    let raster = open(&file.into_inner().into(), 1).unwrap();
                    let expected: Vec<f64> = samples.iter().map(|v| *v as f64).collect();
                    assert_eq!(
                        all(&raster),
                        expected,
                        "{} {number} {predictor:?}",
                        stringify!($color)
                    );
                }};
            }
            check!(Gray8, u8);
            check!(GrayI16, i16);
            check!(Gray32, u32);
            check!(Gray64, u64);
            if predictor == Predictor::None {
                check!(Gray32Float, f32);
                check!(Gray64Float, f64);
            }
        }
    }
}

/// The system that short and double keys describe.
fn described(shorts: &[(u16, u16)], doubles: &[(u16, &[f64])]) -> crate::geo::crs::Crs {
    let mut directory = vec![1, 1, 0, (shorts.len() + doubles.len()) as u16];
    let mut numbers = Vec::new();
    directory.extend(shorts.iter().flat_map(|(key, value)| [*key, 0, 1, *value]));
    for (key, values) in doubles {
        directory.extend([*key, 34736, values.len() as u16, numbers.len() as u16]);
        numbers.extend_from_slice(values);
    }
    let file = Tiff::new(2, 2)
        .with(34735, Field::Short(directory))
        .with(34736, Field::Double(numbers));
    file.open().unwrap().crs.expect("a system")
}

#[test]
fn systems_are_described_by_parameters_in_their_own_units() {
    use crate::geo::crs::Crs;
    const USER: u16 = 32767;
    let head = [(1024, 1), (3072, USER), (2048, USER)];
    let with = |more: &[(u16, u16)]| [&head[..], more].concat();
    let same = |crs: &Crs, text: &str| {
        let known = Crs::parse(text).unwrap();
        assert!(crs.is_same(&known), "{} is not {text}", crs.text());
    };
    // False easting in feet.
    let feet = described(
        &with(&[(3074, USER), (3075, 1), (3076, 9003), (2056, 7019)]),
        &[
            (3080, &[-81.0]),
            (3081, &[24.0]),
            (3082, &[656_166.67]),
            (3092, &[0.9999]),
        ],
    );
    same(
        &feet,
        "+proj=tmerc +lat_0=24 +lon_0=-81 +k_0=0.9999 +x_0=200000.001016 +y_0=0 +ellps=GRS80 +units=us-ft",
    );
    // A shift, and a zone.
    let zone = described(
        &with(&[(3074, 16032), (2056, 7004)]),
        &[(2062, &[598.1, 73.7, 418.2, 0.202, 0.045, -2.455, 6.7])],
    );
    same(
        &zone,
        "+proj=utm +zone=32 +ellps=bessel +towgs84=598.1,73.7,418.2,0.202,0.045,-2.455,6.7",
    );
    // One parallel.
    let cone = described(
        &with(&[(3074, USER), (3075, 9), (2056, 7019)]),
        &[
            (3081, &[47.0]),
            (3080, &[9.0]),
            (3092, &[0.9999]),
            (3082, &[1000.0]),
            (3083, &[2000.0]),
        ],
    );
    same(
        &cone,
        "+proj=lcc +lat_1=47 +lat_0=47 +lon_0=9 +k_0=0.9999 +x_0=1000 +y_0=2000 +ellps=GRS80",
    );
    let swiss = described(
        &[
            (1024, 1),
            (3072, USER),
            (2048, 4150),
            (3074, USER),
            (3075, 9815),
        ],
        &[
            (3088, &[7.439_583_333_333_33]),
            (3089, &[46.952_405_555_555_6]),
            (3090, &[2_600_000.0]),
            (3091, &[1_200_000.0]),
            (3093, &[1.0]),
            (3094, &[90.0]),
            (3096, &[90.0]),
        ],
    );
    same(&swiss, "EPSG:2056");
    for (method, name) in [(16, "sterea"), (17, "eqc")] {
        let parallel: u16 = if method == 17 { 3078 } else { 3081 };
        let crs = described(
            &with(&[(3074, USER), (3075, method), (3076, 9036), (2056, 7030)]),
            &[(parallel, &[48.0]), (3080, &[9.0])],
        );
        let what = if method == 17 { "lat_ts" } else { "lat_0" };
        same(
            &crs,
            &format!("+proj={name} +{what}=48 +lon_0=9 +ellps=WGS84 +units=km"),
        );
    }
}
