//! Scripts that would never end, or fill the memory, end with a diagnostic instead.

use std::time::{Duration, Instant};

use super::*;

/// Long enough for a busy machine; unbounded, each attack takes hours or gigabytes.
const SOON: Duration = Duration::from_secs(20);

fn ends(text: &str) -> Diagnostic {
    let start = Instant::now();
    let e = match run(text) {
        Err(errors) => only(errors),
        Ok(curves) => panic!("{} curves of\n{text}", curves.len()),
    };
    assert!(start.elapsed() < SOON, "{:?} for\n{text}", start.elapsed());
    e
}

/// The body of a mapper that is called on the square.
fn in_mapper(body: &str) -> Diagnostic {
    let body = body.replace('\n', "\n    ");
    ends(&format!(
        "def entry():\n  def mapper(f):\n    {body}\n    return nothing()\n  return map_to_faces(mapper, contour)\n"
    ))
}

#[test]
fn endless_loops() {
    let e = in_mapper("for i in range(1000000):\n  for j in range(1000000):\n    pass");
    assert!(
        e.message
            .starts_with("`mapper` on the face at (50, 50): this takes more than"),
        "{e:?}"
    );
    let e = in_mapper("x = [i for i in range(1000000) for j in range(1000000)]");
    assert!(e.message.contains("more than"), "{e:?}");
    let e = ends(
        "def entry():\n  for i in range(1000000):\n    for j in range(1000000):\n      pass\n  return contour\n",
    );
    assert!(e.message.contains("this takes more than"), "{e:?}");
    let e = ends(
        "for i in range(1000000):\n  for j in range(1000000):\n    pass\ndef entry():\n  return contour\n",
    );
    assert!(e.message.contains("this takes more than"), "{e:?}");
}

#[test]
fn recursion() {
    for text in [
        "def f(n):\n  return f(n + 1)\ndef entry():\n  return f(0)\n",
        "def entry():\n  return lambda region: entry()(region)\n",
        "def t(face):\n  return map_to_faces(t, contour)(face)\ndef entry():\n  return t\n",
        "def t(face):\n  return union(t, t)(face)\ndef entry():\n  return map_to_faces(t, contour)\n",
        "def entry():\n  y = lambda f: f(f)\n  return y(y)\n",
    ] {
        let e = ends(text);
        assert!(e.message.contains("nested too deeply"), "{text} {e:?}");
    }
}

#[test]
fn recursion_fits_a_small_stack() {
    let text = "def t(face):\n  return map_to_faces(t, contour)(face)\ndef entry():\n  return map_to_faces(t, contour)\n";
    let small = std::thread::Builder::new().stack_size(2 << 20);
    small.spawn(|| ends(text)).unwrap().join().unwrap();
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(2)
        .stack_size(2 << 20)
        .build()
        .unwrap();
    pool.install(|| ends(text));
}

#[test]
fn memory() {
    for body in [
        "l = [1]\nfor i in range(40):\n  l = l + l",
        "l = [1]\nfor i in range(40):\n  l += l",
        "l = [1]\nfor i in range(40):\n  l.extend(l)",
        "l = [1]\nfor i in range(40):\n  l *= 4",
        "l = {}\nfor i in range(40):\n  l[i] = str(l) + str(l)",
        "s = 'ab'\nfor i in range(60):\n  s = s + s",
        "s = 'ab'\nfor i in range(60):\n  s += s",
        "s = 'ab'\nfor i in range(60):\n  s = '%s%s' % (s, s)",
        "s = 'ab'\nfor i in range(60):\n  s %= ()\n  s = '{}{}'.format(s, s)",
        "s = 'a' * 2000\nfor i in range(6):\n  s = s.replace('a', s)",
        "s = 'a' * 2000\nfor i in range(6):\n  s = s.join([s] * 2000)",
        "s = 'x' * 300000000",
        "n = 3\nfor i in range(60):\n  n = n * n",
        "n = 3\nfor i in range(60):\n  n *= n",
        "n = 1 << 100001",
        "l = []\nfor i in range(900000):\n  l.append([i] * 200)",
        "l = [[0] * 1000000 for i in range(1000)]",
        "x = max(range(2000000000))",
        "x = list(range(2000000000))",
        "x = sorted(range(2000000000))",
    ] {
        let e = in_mapper(body);
        let said = [
            "more than",
            "too long",
            "beyond 64 bits",
            "Integer overflow",
            "shift",
        ];
        assert!(
            said.iter().any(|part| e.message.contains(part)),
            "{body} {e:?}"
        );
    }
}

#[test]
fn slow_operations_in_fast_loops() {
    for body in [
        "l = [0] * 1000000\nfor i in range(1000000):\n  x = i + 1 in l",
        "l = [0] * 1000000\nfor i in range(1000000):\n  x = sorted(l)",
        "l = [0] * 1000000\nm = [0] * 1000000\nfor i in range(1000000):\n  x = l == m",
        "l = [0] * 1000000\nfor i in range(1000000):\n  x = l[:]",
        "s = 'x' * 1000000\nfor i in range(1000000):\n  x = s.upper()",
        "s = 'x' * 1000000\nfor i in range(1000000):\n  x = (lambda *a: 1)(*[s[1:], 1])",
    ] {
        assert!(in_mapper(body).message.contains("more than"), "{body}");
    }
}

#[test]
fn curves_without_end() {
    for body in [
        "c = contour(f)\nfor i in range(60):\n  c = append(c, c)",
        "c = contour(f)\nfor i in range(1000000):\n  c = append(c, contour(f))",
        "c = contour(f)\nt = lambda r: c\nfor i in range(60):\n  t = union(t, t)\nreturn t(f)",
        "return stripes_partition(stripes_properties(0, 1e-5))(f)",
        "return uniform_partition(irregular_properties(1e9), CROP)(f)",
    ] {
        let e = in_mapper(body);
        let said = ["more than", "nested too deeply", "apart", "too"];
        assert!(
            said.iter().any(|part| e.message.contains(part)),
            "{body} {e:?}"
        );
    }
    let e = ends(
        "def entry():\n  t = contour\n  for i in range(60):\n    t = union(t, t)\n  return t\n",
    );
    assert!(e.message.contains("more than"), "{e:?}");
    let e = ends(
        "def entry():\n  t = contour\n  for i in range(1000):\n    t = map_to_faces(contour, t)\n  return t\n",
    );
    assert!(e.message.contains("follow one another"), "{e:?}");
}

#[test]
fn towers_of_values_can_be_frozen() {
    let text = "
l = []
for i in range(50000):
  l = [l]
def entry():
  f = contour
  for i in range(20000):
    f = (lambda g: lambda region: g(region))(f)
  return lambda region: contour(region)
";
    assert_eq!(curves(text).len(), 4);
    let unions = "
def entry():
  t = contour
  for i in range(20000):
    t = union(contour, t)
  return lambda region: contour(region)
";
    assert_eq!(curves(unions).len(), 4);
    let tower =
        "l = []\nfor i in range(1000000):\n  l = [l]\nfor i in range(1000000):\n  l = [l]\n";
    assert!(
        only(compile(tower).err().unwrap())
            .message
            .contains("more than")
    );
}

#[test]
fn guards_cannot_be_taken_away() {
    for text in [
        "_bounded_add = lambda a, b: a\n",
        "x = getattr([], 'extend')\n",
        "def f(_bounded):\n  pass\n",
    ] {
        assert!(compile(text).is_err(), "{text}");
    }
    let stored = "def entry():\n  l = [1]\n  grow = l.extend\n  for i in range(40):\n    grow(l)\n  return contour\n";
    assert!(ends(stored).message.contains("more than"));
}

#[test]
fn lists_nested_deeper_than_any_stack() {
    let nest = "l = []\nfor i in range(100000):\n  l = [l]\n";
    let uses = [
        "str(l)",
        "repr(l)",
        "'%s' % (l,)",
        "'{}'.format(l)",
        "l == l[:]",
        "fail(l)",
        "has_label(l, 'a')",
        "has_label(f, l)",
        "import_svg(l)",
        "range(l)",
        "'a'.startswith(l)",
        "[].insert(l, 1)",
        "abs(l)",
        "chr(l)",
        "hash(l)",
    ];
    for used in uses {
        let text = format!("{nest}{used}");
        let small = std::thread::Builder::new().stack_size(2 << 20);
        let e = small
            .spawn(move || in_mapper(&text))
            .unwrap()
            .join()
            .unwrap();
        assert!(
            e.message.starts_with("`mapper` on the face at (50, 50): "),
            "{used}: {e:?}"
        );
    }
}

#[test]
fn ranges_beyond_32_bits() {
    for (range, message) in [
        (
            "range(100000000000)",
            "a range of 100000000000 numbers is too long",
        ),
        (
            "range(0, 1 << 62, 1 << 61)",
            "a range takes numbers between",
        ),
        (
            "range(0, 1 << 200)",
            "a range takes whole numbers of at most 64 bits",
        ),
        ("range('a')", "a range takes whole numbers"),
        ("range(1, 2, 0)", "the step of a range cannot be 0"),
    ] {
        let e = in_mapper(range);
        assert!(e.message.contains(message), "{range}: {e:?}");
    }
}
