//! Finished shells as other programs read them: random exemplars become one piece, at every resolution the body is closed and no
//! place of it is pinched. The mesh is read from its file and judged here, without the kernel of the project.

use std::collections::BTreeMap;
use std::io::Cursor;

use super::project::Project;

/// What stands in a file of triangles: each corner by its number.
struct Read {
    corners: usize,
    triangles: Vec<[u32; 3]>,
}

/// The triangles of an STL file. Corners are one where all their bits are.
fn read(project: &Project, name: &str) -> Read {
    let bytes = std::fs::read(project.path(&format!("out/spec/{name}"))).unwrap();
    let file = stl_io::create_stl_reader(&mut Cursor::new(bytes))
        .unwrap()
        .map(|triangle| triangle.unwrap().vertices)
        .collect::<Vec<_>>();
    let mut numbers = BTreeMap::new();
    let mut number = |v: &stl_io::Vertex| {
        let next = numbers.len() as u32;
        *numbers
            .entry([0, 1, 2].map(|i| v[i].to_bits()))
            .or_insert(next)
    };
    let triangles = file
        .iter()
        .map(|t| [0, 1, 2].map(|i| number(&t[i])))
        .collect();
    Read {
        corners: numbers.len(),
        triangles,
    }
}

impl Read {
    /// How many bodies there are: corners that edges join, by sets whose first member stands for all.
    fn bodies(&self) -> usize {
        let mut first: Vec<u32> = (0..self.corners as u32).collect();
        let find = |first: &[u32], mut v: u32| {
            while first[v as usize] != v {
                v = first[v as usize];
            }
            v
        };
        for [a, b, c] in &self.triangles {
            for (v, w) in [(*a, *b), (*b, *c)] {
                let (v, w) = (find(&first, v), find(&first, w));
                let (low, high) = (v.min(w), v.max(w));
                first[high as usize] = low;
            }
        }
        (0..self.corners).filter(|v| first[*v] == *v as u32).count()
    }

    /// What is wrong with it as the closed surface of a body: each edge has two triangles, which pass it in opposite ways, and the
    /// triangles about each corner are one fan.
    fn fault(&self) -> Option<String> {
        let mut edges: BTreeMap<(u32, u32), i32> = BTreeMap::new();
        let mut fans: Vec<BTreeMap<u32, u32>> = vec![BTreeMap::new(); self.corners];
        for &[a, b, c] in &self.triangles {
            if a == b || b == c || c == a {
                return Some(format!("triangle {a} {b} {c} has no area"));
            }
            for (from, to, across) in [(a, b, c), (b, c, a), (c, a, b)] {
                *edges.entry((from, to)).or_insert(0) += 1;
                fans[from as usize].insert(to, across);
            }
        }
        let is_twofold = |(from, to): &(u32, u32)| edges.get(&(*to, *from)) == Some(&1);
        if let Some((edge, _)) = edges.iter().find(|(e, n)| **n != 1 || !is_twofold(e)) {
            return Some(format!("edge {edge:?} has not two triangles"));
        }
        let is_one = |fan: &BTreeMap<u32, u32>| {
            let start = *fan.keys().next().unwrap();
            let mut at = start;
            let mut turn = fan.len();
            loop {
                at = fan[&at];
                turn -= 1;
                if at == start || turn == 0 {
                    return at == start && turn == 0;
                }
            }
        };
        let pinched = fans.iter().position(|fan| !is_one(fan))?;
        Some(format!("the body is pinched in corner {pinched}"))
    }
}

/// A spec with a ball, the given exemplars and shells, and a file of each shell.
fn spec(exemplars: &str, shells: &[(String, String)]) -> String {
    let of = |(name, fields): &(String, String)| {
        format!("  {name}: {{ surface: ball, thickness: 2, {fields} }}\n")
    };
    let file = |(name, _): &(String, String)| format!("  {name}.stl: {{ from: {name} }}\n");
    format!(
        "fretwork: 1\nseed: 5\nsurfaces:\n  ball: {{ revolve: {{ profile: [[0, -15], [5.74, -13.86], [10.61, -10.61], [13.86, -5.74], [15, 0], \
         [13.86, 5.74], [10.61, 10.61], [5.74, 13.86], [0, 15]], segments: 32 }} }}\nexemplars:\n{exemplars}shells:\n{}artifacts:\n{}",
        shells.iter().map(of).collect::<String>(),
        shells.iter().map(file).collect::<String>(),
    )
}

/// Random numbers, as many as a picture has pixels, by a generator of Lehmer's.
fn noise(seed: u64, count: usize) -> Vec<u32> {
    let mut state = seed * 2 + 1;
    let mut next = || {
        state = state * 48_271 % 2_147_483_647;
        state as u32 % 1000
    };
    (0..20).for_each(|_| {
        next();
    });
    (0..count).map(|_| next()).collect()
}

const SIDE: usize = 28;

/// Random blots whose sides join: noise whose values were made the sums of those around them, and the part of it that is above
/// most. The first picture is of dots that touch nowhere.
fn blots(number: u64) -> Vec<bool> {
    if number == 0 {
        let is_dot = |n: usize| (n % SIDE % 14) < 4 && (n / SIDE % 14) < 4;
        return (0..SIDE * SIDE).map(is_dot).collect();
    }
    let mut values = noise(number, SIDE * SIDE);
    for _ in 0..2 {
        let reach = 2 + number as usize % 2;
        let around = |n: usize| {
            let (x, y) = (n % SIDE + SIDE, n / SIDE + SIDE);
            let beside = (0..=2 * reach).flat_map(|i| (0..=2 * reach).map(move |j| (i, j)));
            let value = |(i, j): (usize, usize)| {
                values[(y + j - reach) % SIDE * SIDE + (x + i - reach) % SIDE]
            };
            beside.map(value).sum::<u32>() / 8
        };
        values = (0..SIDE * SIDE).map(around).collect();
    }
    let mut sorted = values.clone();
    sorted.sort_unstable();
    // A part between a quarter and two thirds is solid.
    let least = sorted[SIDE * SIDE * (33 + number as usize * 7 % 42) / 100];
    values.iter().map(|v| *v >= least).collect()
}

/// A picture whose solid pixels are black.
fn png(solid: &[bool]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, SIDE as u32, SIDE as u32);
    encoder.set_color(png::ColorType::Grayscale);
    let pixels: Vec<u8> = solid.iter().map(|s| if *s { 0 } else { 255 }).collect();
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&pixels).unwrap();
    writer.finish().unwrap();
    bytes
}

/// S7: thirty random exemplars from pictures to files, each of them one body.
#[test]
fn shells_of_random_exemplars_are_one_body_each() {
    let count = 30;
    let exemplar = |n: u64| {
        format!(
            "  blots{n}: {{ image: {{ file: blots{n}.png, pixel_size: 0.5, tileable: true }} }}\n"
        )
    };
    let shells: Vec<(String, String)> = (0..count)
        .map(|n| {
            (
                format!("shell{n}"),
                format!("exemplar: blots{n}, resolution: 28"),
            )
        })
        .collect();
    let project = Project::of(&spec(
        &(0..count).map(exemplar).collect::<String>(),
        &shells,
    ));
    let mut joined = 0;
    for n in 0..count {
        let solid = blots(n);
        assert!(solid.contains(&true) && solid.contains(&false), "{n}");
        project.write(&format!("specs/blots{n}.png"), png(&solid));
    }
    let run = project.run(&["build", "specs/spec.yaml"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    for n in 0..count {
        let body = read(&project, &format!("shell{n}.stl"));
        assert_eq!(body.fault(), None, "{n}");
        assert_eq!(body.bodies(), 1, "{n}");
        joined += body.triangles.len();
    }
    assert!(joined > 1000 * count as usize, "{joined}");
}

/// The body is closed, nowhere pinched and one, however fine its voxels are.
#[test]
fn shells_are_closed_at_every_resolution() {
    let exemplar = "  blots: { image: { file: blots.png, pixel_size: 0.5, tileable: true } }\n";
    let resolutions = [24, 40, 64, 96];
    let shells = resolutions.map(|n| {
        let fields = format!("exemplar: blots, resolution: {n}, min_feature: 1.5");
        (format!("shell{n}"), fields)
    });
    let project = Project::of(&spec(exemplar, &shells));
    project.write("specs/blots.png", png(&blots(7)));
    let run = project.run(&["build", "specs/spec.yaml"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let mut least = 0;
    for n in resolutions {
        let body = read(&project, &format!("shell{n}.stl"));
        assert_eq!(body.fault(), None, "{n}");
        assert_eq!(body.bodies(), 1, "{n}");
        assert!(body.triangles.len() > least, "{n}");
        least = body.triangles.len();
    }
}

/// Measures of small shells that no other processor makes other: counts, and fractions in hundredths.
#[test]
fn small_shells_measure_as_before() {
    let exemplars = "  dotted: { image: { file: dots.png, pixel_size: 0.5, tileable: true } }\n  \
                     blotted: { image: { file: blots.png, pixel_size: 0.5, tileable: true } }\n";
    let shells = [
        ("dots", "exemplar: dotted, voxel: 1"),
        ("blots", "exemplar: blotted, voxel: 1, min_feature: 1.5, orientation: { up: [1, 0, 0] }"),
        (
            "guarded",
            "exemplar: blotted, voxel: 0.9, geodesic_limit: 1, keep_solid: [ { lowest: 3mm } ], side: inside",
        ),
    ]
    .map(|(name, fields)| (name.to_owned(), fields.to_owned()));
    let project = Project::of(&spec(exemplars, &shells).replace(".stl", ".json"));
    project.write("specs/dots.png", png(&blots(0)));
    project.write("specs/blots.png", png(&blots(4)));
    let run = project.run(&["build", "specs/spec.yaml"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let shown: String = shells
        .iter()
        .map(|(name, _)| measures(&project, name))
        .collect();
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(concat!(env!("CARGO_MANIFEST_DIR"), "/snapshots"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!("shells_small", shown));
}

/// The measures of a shell as lines.
fn measures(project: &Project, name: &str) -> String {
    let bytes = std::fs::read(project.path(&format!("out/spec/{name}.json"))).unwrap();
    let found: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
    let counts = [
        "voxels",
        "solid_voxels",
        "components",
        "genus",
        "iterations",
        "done",
        "watertight",
        "bridges",
    ];
    let mut text = format!("{name}\n");
    for count in counts {
        text += &format!("  {count} {}\n", found[count]);
    }
    for part in ["exemplar", "before", "after"] {
        let fraction = found["solid_fraction"][part].as_f64().unwrap();
        text += &format!("  solid_fraction.{part} {fraction:.2}\n");
    }
    text
}

/// The `side` of a wall decides where it lies, and with how much of it a tube carries what hangs on it: the stress falls as its
/// section grows from inside to outside.
#[test]
fn the_side_of_a_wall_decides_its_section_and_its_stress() {
    let spec = |side: &str| {
        format!(
            "fretwork: 1
surfaces: {{ tube: {{ revolve: {{ profile: [[8, 0], [8, 30]], segments: 64 }} }} }}
regions: {{ tile: {{ rectangle: {{ width: 8, height: 8, periodic: true }} }}, dot: {{ circle: {{ radius: 2, at: [4, 4] }} }} }}
exemplars: {{ dots: {{ rasterize: {{ from: dot, region: tile, pixel_size: 0.5 }} }} }}
force_profiles:
  hung: {{ material: pla, gravity: [0m/s2, 0m/s2, 0m/s2], supports: [ {{ highest: 2mm }} ], loads: [ {{ lowest: 2mm, force: [0N, 0N, -100N] }} ] }}
shells:
  wall: {{ surface: tube, exemplar: dots, voxel: 0.8, thickness: 3, side: {side}, keep_solid: [ {{ lowest: 100% }} ], force_profile: hung }}
artifacts: {{ wall.json: {{ from: wall }}, wall.stl: {{ from: wall }} }}
"
        )
    };
    let sections = ["inside", "center", "outside"].map(|side| {
        let project = Project::of(&spec(side));
        let run = project.run(&["build", "specs/spec.yaml"]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let body = read(&project, "wall.stl");
        assert_eq!((body.fault(), body.bodies()), (None, 1), "{side}");
        let bytes = std::fs::read(project.path("out/spec/wall.json")).unwrap();
        let found: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
        // All of the middle of a tube is drawn alike: the median is the force over its section.
        let section = 100.0 / (found["stress"]["median"].as_f64().unwrap() * 1e-6);
        let greatest = found["bounds"][1][0].as_f64().unwrap();
        (section, greatest)
    });
    for ((section, greatest), inner) in sections.into_iter().zip([5.0, 6.5, 8.0]) {
        let outer: f64 = inner + 3.0;
        let expected = std::f64::consts::PI * (outer * outer - inner * inner);
        assert!(
            (section / expected - 1.0).abs() < 0.06,
            "{inner}: {section} of {expected}"
        );
        assert!((greatest - outer).abs() < 0.15, "{inner}: {greatest}");
    }
}

/// What the reader above finds wrong: an open body, two bodies, two that touch in a corner.
#[test]
fn the_reader_of_bodies_sees_faults() {
    let solid =
        |at: u32| [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|t| t.map(|v: u32| v + at));
    let of = |triangles: Vec<[u32; 3]>, corners| Read { corners, triangles };
    let one = of(solid(0).to_vec(), 4);
    assert_eq!((one.fault(), one.bodies()), (None, 1));
    let open = of(solid(0)[..3].to_vec(), 4);
    assert!(open.fault().unwrap().contains("not two triangles"));
    let two = of([solid(0), solid(4)].concat(), 8);
    assert_eq!((two.fault(), two.bodies()), (None, 2));
    let pinched = of([solid(0), solid(3)].concat(), 7);
    assert!(pinched.fault().unwrap().contains("pinched"));
    assert_eq!(pinched.bodies(), 1);
}
