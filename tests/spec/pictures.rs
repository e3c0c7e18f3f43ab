//! The pictures of `schemas/functions/`: the example of every function of scripts, built and written by the tool itself in a
//! scene (`scene/`), must give the file that is there.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

use fretwork::arrangement::{Pictured, pictured_functions};
use fretwork::engine::{Compiler, MemoryWorld, Progress, Request, Settings, Steps};

/// More bytes than this are no small picture.
const MOST: usize = 8_000;

/// The cells that examples are functions of, each with what maps it.
const CELLS: [&str; 3] = ["face", "edge", "vertex"];

/// Functions whose example looks like that of another one: the edges around a face are its outline.
const ALIKE: [&str; 1] = ["contour"];

/// The layers of a picture.
const LAYERS: [&str; 4] = ["faces", "context", "given", "result"];

/// Builds without a word.
struct Silent;

impl Progress for Silent {
    fn total(&self, _: usize) {}
    fn started(&self, _: &str, _: &Arc<Steps>) {}
    fn finished(&self, _: &str) {}
}

/// A function to be shown, with its example taken apart.
struct Scene {
    function: Pictured,
    /// What the example assigns to.
    result: String,
    /// The example as a statement.
    statement: String,
    /// The names that it calls with.
    words: BTreeSet<String>,
}

impl Scene {
    fn of(function: Pictured) -> Scene {
        let assigned = function.example.split_once(" = ");
        let called = assigned.map_or(&*function.example, |(_, call)| call);
        let words = called
            .split(|c: char| !c.is_alphanumeric() && c != '_')
            .map(str::to_owned)
            .collect();
        let result = assigned.map_or("given_back", |(name, _)| name).to_owned();
        let statement = format!("{result} = {called}");
        Scene {
            function,
            result,
            statement,
            words,
        }
    }

    fn speaks_of(&self, word: &str) -> bool {
        self.words.contains(word)
    }

    /// The kind of the cell that the example is a function of.
    fn cell(&self) -> Option<&'static str> {
        CELLS.into_iter().find(|cell| self.speaks_of(cell))
    }

    /// The partition by which properties are shown, where the example makes or changes such.
    fn partition(&self) -> Option<&'static str> {
        let name = &*self.function.name;
        if name == "stripes_properties" || self.speaks_of("courses") {
            Some("stripes_partition(courses)")
        } else if name == "irregular_properties" || name.starts_with("set_weighted") {
            Some("uniform_partition(cells, CROP_ADD_BOUNDARY)")
        } else {
            None
        }
    }

    /// What is drawn in grey around a value that no cell is asked for.
    fn context(&self) -> &'static str {
        match &*self.function.name {
            "point" => "lambda region: axes",
            "union" | "export_svg" | "import_svg" => "empty",
            _ if self.speaks_of("blobs") => "blobs",
            _ if self.speaks_of("cells") => "cells",
            _ if self.speaks_of("leaf") => "lambda region: leaf",
            _ => "empty",
        }
    }

    /// The statements that end with the layers of the picture.
    fn layers(&self) -> String {
        let (statement, result) = (&self.statement, &self.result);
        if let Some(partition) = self.partition() {
            return format!(
                "cells = irregular_properties(0.003)\ncourses = stripes_properties(0, 8, 5)\n{statement}\n\
                 layers = of_partition({partition})"
            );
        }
        let example =
            |cell| format!("def example({cell}):\n    {statement}\n    return {result}\n");
        let Some(cell) = self.cell() else {
            let context = self.context();
            return example("") + &format!("layers = alone(example(), {context})");
        };
        let others = if self.speaks_of("leaf") {
            "leaf"
        } else {
            "nothing()"
        };
        example(cell) + &format!("layers = on_cells(\"{cell}\", example, cells, {others})")
    }

    fn script(&self) -> String {
        let entry = |layer| format!("def {layer}():\n    return layers[\"{layer}\"]\n");
        let entries: String = LAYERS.into_iter().map(entry).collect();
        format!(
            "load(\"scene.star\", \"leaf\", \"knob\", \"dot\", \"axes\", \"empty\", \"drawn_cells\", \"drawn_blobs\", \
             \"on_cells\", \"alone\", \"of_partition\")\ncells = drawn_cells()\n\
             rows = stripes_partition(stripes_properties(0, 4))\nblobs = drawn_blobs(cells)\n{}\n\
{entries}",
            self.layers()
        )
    }

    /// The layers of which the faces are filled.
    fn filled(&self) -> Vec<&'static str> {
        let name = &*self.function.name;
        let example = &self.function.example;
        let is_told = matches!(name, "is_boundary" | "is_bounded_face" | "has_label");
        let mut filled = Vec::new();
        if example.contains("'odd'") || example.contains("'big'") {
            filled.push("faces");
        }
        if self.cell() == Some("face") && !is_told {
            filled.push("given");
        }
        if name.ends_with("_face") && name != "match_face" || name == "incident_faces" {
            filled.push("result");
        }
        filled
    }

    fn spec(&self) -> String {
        let (mut areas, mut parts) = (String::new(), String::new());
        for layer in self.filled() {
            // An inset has rings, which are filled; the faces themselves have edges.
            areas += &format!(
                "  {layer}_faces: {{ faces: {{ of: {layer}, region: page }} }}\n  \
                 {layer}_area: {{ inset: {{ from: {layer}_faces, by: 0.6 }} }}\n"
            );
            parts += &format!(" {{ from: {layer}_area, role: draw }},");
        }
        let is_small = self.cell().is_none()
            && (self.speaks_of("leaf") || matches!(&*self.function.name, "point" | "import_svg"));
        include_str!("scene/picture.yaml")
            .replace("WIDTH", if is_small { "44" } else { "100" })
            .replace("AREAS\n", &areas)
            .replace("PARTS", &parts)
    }

    /// The picture, as the tool writes it.
    fn drawn(&self) -> String {
        let mut world = MemoryWorld::default();
        for (file, text) in [
            ("picture.yaml", &*self.spec()),
            ("picture.star", &self.script()),
            ("scene.star", include_str!("scene/scene.star")),
            ("leaf.svg", include_str!("scene/leaf.svg")),
            ("knob.svg", include_str!("scene/knob.svg")),
            ("dot.svg", include_str!("scene/dot.svg")),
            ("arrow.svg", include_str!("scene/arrow.svg")),
            ("axes.svg", include_str!("scene/axes.svg")),
        ] {
            world.files.insert(file.into(), text.into());
        }
        let compiler = Compiler::new(Arc::new(world), None, true);
        let report = compiler.build(&Request {
            specs: vec!["picture.yaml".into()],
            settings: Settings::default(),
            only: Vec::new(),
            windows: Vec::new(),
            threads: 1,
            progress: &Silent,
        });
        let errors: Vec<_> = report.diagnostics.iter().filter(|d| d.is_error()).collect();
        assert!(errors.is_empty(), "{}: {errors:#?}", self.function.name);
        let bytes = compiler.bytes(&report.artifacts[0]).unwrap();
        String::from_utf8(bytes.to_vec()).unwrap()
    }
}

/// The folder of the pictures.
fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("schemas/functions")
}

/// Whether a picture has lines of a colour.
fn has_lines(svg: &str, color: &str) -> bool {
    svg.contains(&format!("stroke=\"{color}\""))
}

#[test]
fn the_pictures_of_functions_are_current_and_show_something() {
    let (mut known, mut seen) = (BTreeSet::new(), BTreeSet::new());
    for function in pictured_functions() {
        let scene = Scene::of(function);
        let name = &scene.function.name;
        let svg = scene.drawn();
        let shows = ["#d9480f", "#7a1fa2"].iter().any(|c| has_lines(&svg, c));
        assert!(shows, "the picture of {name} shows nothing: {svg}");
        let is_given = has_lines(&svg, "#2b6cb0") || svg.contains("fill=\"#d5e6f5\"");
        let is_told = matches!(&**name, "has_label" | "is_boundary" | "is_bounded_face");
        assert!(
            scene.cell().is_none() || is_given || is_told,
            "{name} shows no cell"
        );
        let is_new = seen.insert(svg.clone()) || ALIKE.contains(&&**name);
        assert!(is_new, "{name} looks like another");
        assert!(svg.len() < MOST, "{name}: {} bytes", svg.len());
        let path = folder().join(format!("{name}.svg"));
        if std::env::var_os("UPDATE_SCHEMAS").is_some() {
            std::fs::create_dir_all(folder()).unwrap();
            std::fs::write(&path, &svg).unwrap();
        }
        let found = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(
            found == svg,
            "{} is stale: run the tests with UPDATE_SCHEMAS=1, and look at it",
            path.display()
        );
        known.insert(format!("{name}.svg"));
    }
    let files = std::fs::read_dir(folder()).unwrap();
    let files = files.map(|file| file.unwrap().file_name().into_string().unwrap());
    assert_eq!(files.collect::<BTreeSet<_>>(), known);
}
