//! Which file of a room uses which: there must be no circle. Read from the text, by `use` and by paths that begin in
//! `crate`, `super` or `self`; a name that a module only hands on is followed to the file that defines it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The rooms that are held to it.
const ROOMS: &[&str] = &[
    "artifact",
    "cli",
    "diagnostic",
    "fabricate",
    "geometry",
    "graph",
    "shell",
    "solid",
    "store",
    "wrap",
];

/// A module as the names on the way to it from the root of its package.
type Module = Vec<String>;

/// What a file imports, and what it hands on.
#[derive(Default)]
struct Imports {
    used: Vec<String>,
    handed_on: Vec<String>,
}

type Package = BTreeMap<Module, Imports>;

#[test]
fn no_file_of_a_room_uses_itself_through_others() {
    for room in ROOMS {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(room);
        let package = read(&folder);
        assert!(!package.is_empty(), "{room} has no files");
        let circle = circle(&edges(&package));
        assert!(circle.is_none(), "a circle in {room}: {circle:?}");
    }
}

#[test]
fn a_circle_is_found_through_names_that_are_handed_on() {
    let file = |name: &str, text: &str| {
        let module: Module = name
            .split("::")
            .filter(|s| !s.is_empty())
            .map(Into::into)
            .collect();
        (module, imports(text))
    };
    let mut package = Package::from([
        file("", "mod a; mod b; pub use a::One;"),
        file("a", "use crate::b::{Two, c::Three};\npub struct One;"),
        file("b", "mod c; pub use c::Four;\nfn f() {}"),
        file("b::c", "// use crate::a::One;\npub struct Four;"),
    ]);
    assert_eq!(circle(&edges(&package)), None);
    package.extend([file("b::c", "fn f(one: crate::One) {}")]);
    assert!(circle(&edges(&package)).is_some());
}

fn read(folder: &Path) -> Package {
    let mut package = Package::new();
    let mut waiting = vec![(folder.to_owned(), Module::new())];
    while let Some((folder, module)) = waiting.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            let is_code = path.extension().is_some_and(|e| e == "rs");
            let mut inner = module.clone();
            if !matches!(&*name, "mod" | "lib" | "main") {
                inner.push(name);
            }
            if inner.iter().any(|part| part == "tests") {
                continue;
            }
            if path.is_dir() {
                waiting.push((path, inner));
            } else if is_code {
                package.insert(inner, imports(&fs::read_to_string(&path).unwrap()));
            }
        }
    }
    package
}

/// The imports of a file, without its tests and comments.
fn imports(text: &str) -> Imports {
    let code = text.split("#[cfg(test)]").next().unwrap_or(text);
    let lines = code
        .lines()
        .map(|line| line.split("//").next().unwrap_or(line));
    let code = lines.collect::<Vec<_>>().join("\n");
    let mut imports = Imports::default();
    for statement in code.split(';') {
        let words = statement.trim_start();
        let start = words.rfind("\nuse ").map(|at| at + 1).unwrap_or(0);
        let (head, path) = match words[start..].strip_prefix("use ") {
            Some(path) => ("", path),
            None => match words.rsplit_once(" use ") {
                Some((head, path)) if head.trim_start().starts_with("pub") => ("pub", path),
                _ => {
                    imports.used.extend(inline_paths(words));
                    continue;
                }
            },
        };
        let paths = flattened(path);
        if head == "pub" {
            imports.handed_on.extend(paths);
        } else {
            imports.used.extend(paths);
        }
    }
    imports
}

/// The paths in code that begin in the package.
fn inline_paths(code: &str) -> Vec<String> {
    let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    code.split(|c| !is_part(c))
        .filter(|word| {
            let starts = ["crate::", "super::", "self::"];
            starts.iter().any(|start| word.starts_with(start))
        })
        .map(|word| word.trim_end_matches(':').to_owned())
        .collect()
}

/// `a::{b, c::d as e}` as `a::b` and `a::c::d`.
fn flattened(path: &str) -> Vec<String> {
    let (Some(open), Some(close)) = (path.find('{'), path.rfind('}')) else {
        let name = path.split(" as ").next().unwrap_or(path);
        return vec![name.split_whitespace().collect()];
    };
    let prefix: String = path[..open].split_whitespace().collect();
    let mut depth = 0;
    let items = path[open + 1..close].split(|c| {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        c == ',' && depth == 0
    });
    items
        .filter(|item| !item.trim().is_empty())
        .flat_map(flattened)
        .map(|item| format!("{prefix}{item}"))
        .collect()
}

fn edges(package: &Package) -> BTreeMap<&Module, BTreeSet<Module>> {
    package
        .iter()
        .map(|(module, imports)| {
            let used = imports
                .used
                .iter()
                .filter_map(|path| resolve(package, module, path));
            (module, used.filter(|other| other != module).collect())
        })
        .collect()
}

/// The module that defines what a path names; none outside of the package.
fn resolve(package: &Package, from: &Module, path: &str) -> Option<Module> {
    let mut parts: Vec<&str> = path.split("::").filter(|part| *part != "*").collect();
    let mut at = match parts.first()? {
        &"crate" => Module::new(),
        &("super" | "self") => from.clone(),
        first => {
            let inner = [&from[..], &[first.to_string()]].concat();
            package.contains_key(&inner).then(|| from.clone())?
        }
    };
    while let Some(&("crate" | "self" | "super")) = parts.first() {
        if parts.remove(0) == "super" {
            at.pop();
        }
    }
    while let Some(part) = parts.first() {
        let inner = [&at[..], &[part.to_string()]].concat();
        if package.contains_key(&inner) {
            at = inner;
            parts.remove(0);
            continue;
        }
        let handed_on = package.get(&at)?.handed_on.iter();
        let mut named = handed_on.filter(|path| path.rsplit("::").next() == Some(part));
        let definition = named.find_map(|path| resolve(package, &at, path));
        return Some(definition.unwrap_or(at));
    }
    Some(at)
}

/// Some modules that use one another in a circle: what is left when modules that use nothing that is left are taken away.
fn circle(edges: &BTreeMap<&Module, BTreeSet<Module>>) -> Option<Vec<String>> {
    let mut left: BTreeSet<&Module> = edges.keys().copied().collect();
    loop {
        let free = |m: &&Module| edges[*m].iter().all(|other| !left.contains(other));
        let taken: Vec<&Module> = left.iter().copied().filter(free).collect();
        if taken.is_empty() {
            break;
        }
        taken.iter().for_each(|m| {
            left.remove(*m);
        });
    }
    let names = left.iter().map(|m| m.join("::")).collect::<Vec<_>>();
    (!names.is_empty()).then_some(names)
}
