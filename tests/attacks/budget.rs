//! Small specs that ask for too much: each is a file, or one message that tells what is too much and
//! how to allow for it, and the same for any number of threads.

use std::fmt::Write as _;
use std::process::Command;

use super::super::project::{Project, Random, Run, finish};

/// A build without a cache, of which nothing may take more than 30 seconds of a core and so many
/// megabytes of addresses, on this number of threads.
fn limited(project: &Project, megabytes: u32, threads: u32, more: &str) -> Run {
    let limits = format!("ulimit -v {}; ulimit -t 30", megabytes * 1024);
    let mut command = Command::new("bash");
    command.current_dir(project.path(""));
    command.arg("-c").arg(format!(
        "{limits}; exec \"$0\" build --no-cache --jobs {threads} {more}"
    ));
    command.arg(env!("CARGO_BIN_EXE_fretwork"));
    command.env("RAYON_NUM_THREADS", threads.to_string());
    finish(command)
}

/// A twentieth of the budget: what needs more than all of it needs more than that, and tests end soon.
const SMALL: &str = "--budget 0.05";

/// The message with which the only spec of a project is refused, whatever the number of threads.
#[track_caller]
fn refused(project: &Project, budget: &str) -> String {
    let run = limited(project, 3000, 2, budget);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    for threads in [1, 16] {
        let other = limited(project, 3000, threads, budget);
        assert_eq!((run.code, &run.stderr), (other.code, &other.stderr));
    }
    assert_eq!(project.files("out").len(), 0);
    run.stderr
}

#[track_caller]
fn is_refused(spec: &str, what: &str) {
    let message = refused(&Project::of(spec), SMALL);
    assert!(message.contains(what), "{message}");
    assert!(message.contains("--budget"), "{message}");
    assert_eq!(message.matches("error").count(), 1, "{message}");
}

const PAGE: &str = "fretwork: 1\nregions:\n  page: { rectangle: { width: 20, height: 10 } }\n";

#[test]
fn text_that_doubles_is_refused_by_check() {
    let mut spec = "fretwork: 1\nlet:\n  a0: xxxxxxxxxx\n".to_string();
    for i in 1..40 {
        writeln!(spec, "  a{i}: \"${{a{0}}}${{a{0}}}\"", i - 1).unwrap();
    }
    spec += "regions:\n  page: { rectangle: { width: 20, height: 10 } }\nartifacts:\n  x.svg: { from: page }\n";
    let project = Project::of(&spec);
    let run = project.run(&["check"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    let messages = run.stderr.matches("longer than 1048576 bytes").count();
    assert_eq!(messages, 1, "{}", run.stderr);
}

#[test]
fn lists_that_double_are_refused_by_check() {
    for entry in ["[\"${a}\", \"${a}\"]", "{ x: \"${a}\", y: \"${a}\" }"] {
        let mut spec = "fretwork: 1\nlet:\n  a0: [1, 2]\n".to_string();
        for i in 1..40 {
            let value = entry.replace("${a}", &format!("${{a{}}}", i - 1));
            writeln!(spec, "  a{i}: {value}").unwrap();
        }
        let run = Project::of(&spec).run(&["check"]);
        assert_eq!(run.code, Some(1), "{}", run.stderr);
        assert_eq!(run.stderr.matches("more than").count(), 1, "{}", run.stderr);
    }
}

#[test]
fn a_file_of_too_many_triangles_is_refused() {
    let spec = "fretwork: 1
solids:
  ball: { sphere: { radius: 1, segments: 251 } }
  balls: { assemble: { union: false, parts: [ { from: ball, repeat: { count: 9204, step: [0.84, 0, 0] } } ] } }
artifacts:
  balls.stl: { from: balls }
";
    let run = Project::of(spec).run(&["build"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    assert!(run.stderr.contains("triangles of a file"), "{}", run.stderr);
}

#[test]
fn copies_of_copies_are_refused() {
    let mut spec =
        "fretwork: 1\nregions:\n  r: { circle: { radius: 1 } }\narrangements:\n".to_string();
    spec += "  t0: { transform: { faces: r, repeat: { count: 1000, step: [1, 0] } } }\n";
    for i in 1..6 {
        writeln!(
            spec,
            "  t{i}: {{ transform: {{ faces: t{}, repeat: {{ count: 1000, step: [1, 0] }} }} }}",
            i - 1
        )
        .unwrap();
    }
    spec += "artifacts:\n  o.svg: { from: t5, region: r }\n";
    is_refused(&spec, "points");
}

#[test]
fn copies_on_one_another_are_refused() {
    for repeat in [
        "{ radius: 1, repeat: { count: [300, 300], step: [0.01, 0.01] } }",
        "{ radius: 100, at: [1, 0], repeat: { count: 3000, turn: 0.12 } }",
    ] {
        let spec = format!(
            "fretwork: 1\nregions:\n  r: {{ circle: {repeat} }}\nartifacts:\n  o.svg: {{ from: r }}\n"
        );
        is_refused(&spec, "of");
    }
}

#[test]
fn bodies_that_pass_through_one_another_are_refused_or_united() {
    let spec = "fretwork: 1
solids:
  s: { assemble: { union: true, parts: [ { from: b, repeat: { count: 2000, step: [0.5, 0, 0] } } ] } }
  b: { sphere: { radius: 1 } }
artifacts:
  o.stl: { from: s }
";
    let run = limited(&Project::of(spec), 3000, 2, SMALL);
    assert!(matches!(run.code, Some(0 | 1)), "{}", run.stderr);
    assert!(
        run.code == Some(0) || run.stderr.contains("--budget"),
        "{}",
        run.stderr
    );
}

#[test]
fn a_crowd_of_cells_is_refused() {
    let partition = "partitions:\n  p: { random: { density: 10000 } }\n";
    let artifacts = "artifacts:\n  o.svg: { from: p, region: page }\n";
    is_refused(&format!("{PAGE}{partition}{artifacts}"), "cells");
}

#[test]
fn wide_lines_on_one_another_end() {
    for (cell, width) in [(0.3, 1000.0), (0.05, 0.01)] {
        let spec = format!(
            "{PAGE}partitions:\n  p: {{ random: {{ cell_size: {cell} }} }}\narrangements:\n  \
             c: {{ connect: {{ input: p, region: page, width: {width} }} }}\nartifacts:\n  o.svg: {{ from: c }}\n"
        );
        let run = limited(&Project::of(&spec), 3000, 2, SMALL);
        assert!(matches!(run.code, Some(0 | 1)), "{}", run.stderr);
        assert!(
            run.code == Some(0) || run.stderr.contains("--budget"),
            "{}",
            run.stderr
        );
    }
}

#[test]
fn counters_of_a_thousand_million_values_are_refused() {
    let spec = "fretwork: 1
symbols: { A: { size: 1, opaque: true } }
patterns: { p: \"A^k\" }
layers: { l: { x: p, y: p } }
facades:
  f:
    canvas: { width: 10, height: 10 }
    counters: { k: { min: -1000000000, max: 1000000000 } }
    layers: [l]
    shapes: { \"*\": { box: { depth: 0.2 } } }
artifacts:
  o.glb: { from: f }
";
    is_refused(spec, "counters");
}

#[test]
fn files_of_one_list_hold_no_lists() {
    let spec = format!(
        "params: {{ n: 0 }}\n{PAGE}artifacts:\n  \"o${{n}}.json\": {{ each: {{ n: \"${{list(range(3000))}}\" }}, from: page }}\n"
    );
    let project = Project::of(&spec);
    let run = limited(&project, 1000, 2, "--only o7.json");
    assert_eq!(run.code, Some(0), "{}", run.stderr);
}

#[test]
fn many_nodes_are_refused_together() {
    let mut spec = format!("{PAGE}partitions:\n");
    for i in 0..60 {
        writeln!(spec, "  p{i}: {{ random: {{ density: 100 }} }}").unwrap();
    }
    spec += "artifacts:\n";
    for i in 0..60 {
        writeln!(spec, "  o{i}.json: {{ from: p{i}, region: page }}").unwrap();
    }
    is_refused(&spec, "together");
}

#[test]
fn a_budget_allows_for_more() {
    let spec = format!(
        "{PAGE}partitions:\n  p: {{ random: {{ density: 20 }} }}\nartifacts:\n  o.json: {{ from: p, region: page }}\n"
    );
    let project = Project::of(&spec);
    for wrong in ["0", "-1", "x", "NaN", "1e9"] {
        let run = project.run(&["build", &format!("--budget={wrong}")]);
        assert_eq!(run.code, Some(2), "{wrong}: {}", run.stderr);
    }
    let small = ["build", "--budget", "0.001"];
    let run = project.run(&small);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    assert!(run.stderr.contains("`--budget 1`"), "{}", run.stderr);
    project.succeed(&["build"]);
    // What the cache holds is not charged.
    project.succeed(&small);
}

#[test]
fn scripts_have_one_stack_whatever_the_number_of_threads() {
    let project = Project::empty();
    let mut spec = format!("{PAGE}arrangements:\n");
    for i in 0..12 {
        project.write(
            &format!("specs/s{i}.star"),
            "x = [i for i in range(30000)]\ndef make():\n  return lambda face: contour(face)\n",
        );
        writeln!(
            spec,
            "  a{i}: {{ map: {{ faces: page, with: {{ script: s{i}.star, entry: make }} }} }}"
        )
        .unwrap();
    }
    spec += "artifacts:\n";
    for i in 0..12 {
        writeln!(spec, "  o{i}.svg: {{ from: a{i}, region: page }}").unwrap();
    }
    project.write("specs/spec.yaml", spec);
    for threads in [2, 16] {
        let run = limited(&project, 2000, threads, "--overwrite");
        assert_eq!(run.code, Some(0), "{threads}: {}", run.stderr);
        assert_eq!(project.files("out").len(), 12);
    }
}

#[test]
fn mappers_share_the_memory_of_one_whatever_the_number_of_threads() {
    let project = Project::empty();
    project.write(
        "specs/a.star",
        "def make():\n  def mapper(face):\n    x = [0] * 30000000\n    y = [i for i in range(1000000)]\n    \
         return contour(face)\n  return mapper\n",
    );
    project.write(
        "specs/spec.yaml",
        format!(
            "{PAGE}partitions:\n  g: {{ grid: {{ across: {{ spacing: 0.5 }}, along: {{ angle: 90, spacing: 0.5 }} }} }}\n\
             arrangements:\n  a: {{ map: {{ faces: g, with: {{ script: a.star, entry: make }} }} }}\n\
             artifacts:\n  page.svg: {{ from: a, region: page }}\n"
        ),
    );
    let message = refused(&project, "");
    assert!(message.contains("64 MiB of memory"), "{message}");
}

#[test]
fn a_picture_that_is_broken_or_huge_is_no_texture() {
    let project = Project::of(
        "fretwork: 1
symbols: { A: { size: 1, opaque: true } }
patterns: { p: \"A\" }
layers: { l: { x: p, y: p } }
facades:
  f:
    canvas: { width: 2, height: 2 }
    layers: [l]
    shapes: { \"*\": { box: { depth: 0.2 }, material: { texture: p.png } } }
artifacts:
  o.glb: { from: f }
",
    );
    let mut huge = Vec::new();
    let mut encoder = png::Encoder::new(&mut huge, (1 << 31) - 1, (1 << 31) - 1);
    encoder.set_color(png::ColorType::Rgb);
    drop(encoder.write_header().unwrap());
    let mut whole = Vec::new();
    let mut encoder = png::Encoder::new(&mut whole, 4, 4);
    encoder.set_color(png::ColorType::Grayscale);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[7; 16]).unwrap();
    writer.finish().unwrap();
    for (bytes, is_good) in [
        (&huge[..], false),
        (&whole[..whole.len() / 2], false),
        (&whole, true),
    ] {
        project.write("specs/p.png", bytes);
        let run = limited(&project, 2000, 2, "");
        assert_eq!(run.code, Some(i32::from(!is_good)), "{}", run.stderr);
        assert!(
            is_good || run.stderr.contains("cannot be a texture"),
            "{}",
            run.stderr
        );
    }
}

/// A shell of a vase with a small picture, or `many` of them.
fn shells(fields: &str, many: usize) -> Project {
    let mut spec = "fretwork: 1
surfaces:
  body: { revolve: { profile: [[20, 0], [35, 40], [18, 90]] } }
exemplars:
  skin: { image: { file: p.png, pixel_size: 1 } }
force_profiles:
  standing: { material: petg, supports: [ { lowest: \"10%\" } ], sweep: gravity }
shells:
"
    .to_string();
    for i in 0..many {
        let _ = writeln!(
            spec,
            "  s{i}: {{ surface: body, exemplar: skin, thickness: 2.{i}, force_profile: standing, {fields} }}"
        );
    }
    spec += "artifacts:\n";
    for i in 0..many {
        let _ = writeln!(spec, "  s{i}.stl: {{ from: s{i} }}");
    }
    let project = Project::of(&spec);
    let mut picture = Vec::new();
    let mut encoder = png::Encoder::new(&mut picture, 16, 16);
    encoder.set_color(png::ColorType::Grayscale);
    let mut writer = encoder.write_header().unwrap();
    let pixel = |n: u32| if n % 16 < 8 || n < 96 { 0 } else { 255 };
    let pixels: Vec<u8> = (0..256).map(pixel).collect();
    writer.write_image_data(&pixels).unwrap();
    writer.finish().unwrap();
    project.write("specs/p.png", picture);
    project
}

#[test]
fn shells_of_too_many_voxels_are_refused() {
    for fields in ["resolution: 2000", "resolution: 100000", "voxel: 0.000001"] {
        let message = refused(&shells(fields, 1), "");
        assert_eq!(message.matches("1 error").count(), 1, "{message}");
        assert!(message.contains("voxels"), "{message}");
    }
    // A part of the memory refuses what the whole allows for.
    let message = refused(&shells("resolution: 300", 1), SMALL);
    assert!(message.contains("--budget"), "{message}");
}

#[test]
fn features_as_wide_as_a_house_do_not_take_for_ever() {
    let run = limited(
        &shells("resolution: 32, min_feature: 1000000, analysis: false", 1),
        3000,
        2,
        "",
    );
    assert_eq!(run.code, Some(0), "{}", run.stderr);
}

#[test]
fn many_shells_are_refused_together() {
    let message = refused(
        &shells("resolution: 48, analysis: false", 12),
        "--budget 0.02",
    );
    assert!(message.contains("together"), "{message}");
}

#[test]
fn analyses_of_too_many_voxels_are_refused() {
    for voxel in ["0.0001", "0.3", "0.5"] {
        let spec = format!(
            "fretwork: 1
solids:
  b: {{ box: {{ size: [100, 100, 100] }} }}
force_profiles:
  standing: {{ material: petg, supports: [ {{ lowest: \"10%\" }} ] }}
analyses:
  a: {{ of: b, force_profile: standing, voxel: {voxel} }}
artifacts:
  a.json: {{ from: a }}
"
        );
        let message = refused(&Project::of(&spec), "");
        assert!(message.contains("voxels"), "{voxel}: {message}");
    }
}

/// A number up to `most` that is small as often as it is large.
fn drawn(random: &mut Random, most: f64) -> u64 {
    let part = random.below(1001) as f64 / 1000.0;
    most.powf(part) as u64
}

/// A spec of a few nodes, most of which ask for much.
fn large(random: &mut Random) -> String {
    let mut spec = PAGE.to_string();
    let n = |random: &mut Random, most: f64| drawn(random, most).max(1);
    let (count, segments) = (n(random, 1e5), n(random, 1e6).max(3));
    let _ = write!(
        spec,
        "  r: {{ circle: {{ radius: {}, repeat: {{ count: {count}, step: [0.{}, 0] }} }} }}
partitions:
  p: {{ random: {{ density: {} }} }}
  s: {{ stripes: {{ spacing: {} }} }}
arrangements:
  t0: {{ transform: {{ faces: p, repeat: {{ count: {}, step: [1, 0] }} }} }}
  t1: {{ transform: {{ edges: t0, repeat: {{ count: {}, turn: 3 }} }} }}
  u: {{ union: [t1, s] }}
  c: {{ connect: {{ input: p, region: page, width: 0.{} }} }}
fields:
  f: {{ expression: {{ value: \"x * y * {}\" }} }}
solids:
  b: {{ sphere: {{ radius: 1, segments: {segments} }} }}
  a: {{ assemble: {{ union: {}, parts: [ {{ from: b, repeat: {{ count: {}, step: [0.{}, 0, 0] }} }} ] }} }}
artifacts:
",
        n(random, 100.0),
        random.below(99) + 1,
        n(random, 1e6),
        1.0 / drawn(random, 1e7).max(1) as f64,
        n(random, 1e4),
        n(random, 1e4),
        random.below(99) + 1,
        n(random, 1e6),
        random.below(2) == 0,
        n(random, 1e4),
        random.below(99) + 1,
    );
    let artifacts = [
        "  r.svg: { from: r }\n",
        "  p.svg: { from: p, region: page }\n",
        "  u.dxf: { from: u, region: page }\n",
        "  c.svg: { from: c }\n",
        "  a.stl: { from: a }\n",
        "  f.png: { from: f, region: page, width: 20000 }\n",
    ];
    let chosen = random.below(artifacts.len() as u64) as usize;
    spec += artifacts[chosen];
    if random.below(3) == 0 {
        spec += artifacts[(chosen + 1) % artifacts.len()];
    }
    spec
}

/// Random specs end within time and memory with all their files or one message for a node, and
/// with the same for any number of threads.
fn build_large_specs(rounds: u64, budget: &str, mut random: Random) {
    for round in 0..rounds {
        let spec = large(&mut random);
        println!("{round}: {spec}");
        let project = Project::of(&spec);
        let outcome = |threads: u32| {
            let _ = std::fs::remove_dir_all(project.path("out"));
            // The system's allocator sets 64 MB of addresses aside for every thread, which are no memory.
            let megabytes = 2000 + 64 * threads.saturating_sub(2);
            let more = format!("--overwrite {budget}");
            let run = limited(&project, megabytes, threads, &more);
            (run.code, run.stderr, project.files("out"))
        };
        let two = outcome(2);
        assert!(matches!(two.0, Some(0 | 1)), "{}", two.1);
        assert!(two.0 == Some(0) || two.1.contains("error"), "{}", two.1);
        for threads in [1, 16] {
            assert!(two == outcome(threads), "{threads} threads: {}", two.1);
        }
    }
}

#[test]
fn large_specs_end_with_a_file_or_a_message() {
    build_large_specs(8, SMALL, Random(11));
}

#[test]
#[ignore = "hours; for a while by hand"]
fn many_large_specs_end_with_a_file_or_a_message() {
    build_large_specs(500, "", Random(12));
}
