//! What the functions of numbers, the constants and the standard functions mean to who calls them: the words of their reference.
//! How they are computed is in `mathematics` and in the sandbox.

/// A name of the language, explained.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Explained {
    /// How it is written, with its arguments; those in brackets may be left out.
    pub call: &'static str,
    /// What it gives, with units.
    pub summary: &'static str,
    /// On what it fails; empty where it never does.
    pub fails: &'static str,
    /// A call.
    pub example: &'static str,
    /// What the example gives.
    pub value: &'static str,
}

impl Explained {
    /// The name alone.
    pub fn name(&self) -> &'static str {
        self.call.split('(').next().unwrap_or(self.call)
    }
}

const fn of(
    call: &'static str,
    summary: &'static str,
    fails: &'static str,
    [example, value]: [&'static str; 2],
) -> Explained {
    Explained {
        call,
        summary,
        fails,
        example,
        value,
    }
}

/// The constants.
pub const CONSTANTS: [Explained; 2] = [
    of(
        "deg",
        "One degree in radians, to be multiplied with.",
        "",
        ["round(sin(30 * deg), 6)", "0.5"],
    ),
    of(
        "pi",
        "Half the way around a circle of radius 1.",
        "",
        ["round(2 * pi * 10, 2)", "62.83"],
    ),
];

/// The functions of numbers, in the order of their names.
pub const NUMBERS: [Explained; 28] = [
    of(
        "abs(x)",
        "The number without its sign, in the same unit.",
        "",
        ["abs(-2.5)", "2.5"],
    ),
    of(
        "acos(x)",
        "The angle whose cosine is x, in radians from 0 to pi.",
        "numbers outside of -1 to 1",
        ["degrees(acos(0))", "90.0"],
    ),
    of(
        "asin(x)",
        "The angle whose sine is x, in radians from -pi/2 to pi/2.",
        "numbers outside of -1 to 1",
        ["degrees(asin(1))", "90.0"],
    ),
    of(
        "atan(x)",
        "The angle whose tangent is x, in radians from -pi/2 to pi/2.",
        "",
        ["atan(0)", "0.0"],
    ),
    of(
        "atan2(y, x)",
        "The angle from +x to (x, y), in radians from -pi to pi.",
        "",
        ["degrees(atan2(1, 0))", "90.0"],
    ),
    of("cbrt(x)", "The cube root.", "", ["cbrt(27)", "3.0"]),
    of(
        "ceil(x)",
        "The least whole number that is not below x.",
        "",
        ["ceil(2.1)", "3"],
    ),
    of(
        "cos(angle)",
        "The cosine of an angle in radians.",
        "",
        ["cos(0)", "1.0"],
    ),
    of(
        "cosh(x)",
        "The hyperbolic cosine.",
        "results that are too large",
        ["cosh(0)", "1.0"],
    ),
    of(
        "degrees(angle)",
        "Radians as degrees.",
        "",
        ["degrees(pi)", "180.0"],
    ),
    of(
        "exp(x)",
        "Euler's number to the power x.",
        "results that are too large",
        ["exp(0)", "1.0"],
    ),
    of(
        "floor(x)",
        "The greatest whole number that is not above x.",
        "",
        ["floor(2.9)", "2"],
    ),
    of(
        "hypot(x, y, [z])",
        "The length of a vector, in the unit of its coordinates.",
        "",
        ["hypot(3, 4)", "5.0"],
    ),
    of(
        "log(x, [base])",
        "The logarithm, natural where no base is given.",
        "numbers that are not above 0",
        ["log(8, 2)", "3.0"],
    ),
    of(
        "log10(x)",
        "The logarithm of base 10.",
        "numbers that are not above 0",
        ["log10(1000)", "3.0"],
    ),
    of(
        "log2(x)",
        "The logarithm of base 2.",
        "numbers that are not above 0",
        ["log2(8)", "3.0"],
    ),
    of(
        "max(x, y, …)",
        "The greatest; in scripts and in `${…}` also of a list.",
        "an empty list",
        ["max(2, 7, 5)", "7"],
    ),
    of(
        "min(x, y, …)",
        "The least; in scripts and in `${…}` also of a list.",
        "an empty list",
        ["min(2, 7, 5)", "2"],
    ),
    of(
        "pow(x, y)",
        "x to the power y; whole where both are and y is not below 0.",
        "a power that is no number, or too large",
        ["pow(2, 10)", "1024"],
    ),
    of(
        "radians(angle)",
        "Degrees as radians.",
        "",
        ["radians(0)", "0.0"],
    ),
    of(
        "round(x, [digits])",
        "The nearest whole number, halves away from zero; or so many digits after the point.",
        "",
        ["round(2.345, 1)", "2.3"],
    ),
    of("sign(x)", "-1, 0 or 1.", "", ["sign(-4)", "-1"]),
    of(
        "sin(angle)",
        "The sine of an angle in radians.",
        "",
        ["sin(0)", "0.0"],
    ),
    of(
        "sinh(x)",
        "The hyperbolic sine.",
        "results that are too large",
        ["sinh(0)", "0.0"],
    ),
    of(
        "sqrt(x)",
        "The square root: of an area the side of its square.",
        "numbers below 0",
        ["sqrt(9)", "3.0"],
    ),
    of(
        "tan(angle)",
        "The tangent of an angle in radians.",
        "",
        ["tan(0)", "0.0"],
    ),
    of("tanh(x)", "The hyperbolic tangent.", "", ["tanh(0)", "0.0"]),
    of(
        "trunc(x)",
        "The whole part, toward zero.",
        "",
        ["trunc(-2.9)", "-2"],
    ),
];

/// The standard functions of Starlark, beside those of numbers, in the order of their names.
pub const STANDARD: [Explained; 23] = [
    of(
        "all(values)",
        "Whether every value is true.",
        "what is no list",
        ["all([1, 0])", "False"],
    ),
    of(
        "any(values)",
        "Whether one of the values is true.",
        "what is no list",
        ["any([1, 0])", "True"],
    ),
    of(
        "bool(value)",
        "Whether a value is true: neither 0 nor empty, `None` or `False`.",
        "",
        ["bool([])", "False"],
    ),
    of(
        "chr(code)",
        "The letter of a code point.",
        "a number that is none",
        ["chr(65)", "\"A\""],
    ),
    of(
        "dict(pairs)",
        "A table of keys and values.",
        "what are no pairs",
        ["dict([(\"a\", 1)])", "{\"a\": 1}"],
    ),
    of(
        "enumerate(values, [start])",
        "Pairs of numbers and values.",
        "what is no list",
        ["enumerate([\"a\"])[0][1]", "\"a\""],
    ),
    of(
        "fail(message)",
        "Ends with an error.",
        "all that it is called with",
        ["1 if True else fail(\"no\")", "1"],
    ),
    of(
        "float(value)",
        "A number with a fraction, also of text.",
        "text that is no number",
        ["float(\"2.5\")", "2.5"],
    ),
    of(
        "hasattr(value, name)",
        "Whether a value has such a field.",
        "",
        ["hasattr([], \"append\")", "True"],
    ),
    of(
        "hash(text)",
        "A whole number that stands for a text.",
        "what is no text",
        ["hash(\"a\") == hash(\"a\")", "True"],
    ),
    of(
        "int(value, [base])",
        "A whole number, also of text.",
        "text that is no whole number",
        ["int(\"12\")", "12"],
    ),
    of(
        "len(values)",
        "How many values a list has, or letters a text.",
        "numbers",
        ["len([4, 5])", "2"],
    ),
    of(
        "list(values)",
        "A list of the values.",
        "what is no list",
        ["list(range(3))", "[0, 1, 2]"],
    ),
    of(
        "ord(letter)",
        "The code point of a letter.",
        "more than one letter",
        ["ord(\"A\")", "65"],
    ),
    of(
        "print(…)",
        "Nothing: a script's only way out is its result.",
        "",
        ["1", "1"],
    ),
    of(
        "range([start], stop, [step])",
        "Whole numbers from `start`, 0 if it is not given, to below `stop`.",
        "a step of 0, more numbers than are allowed",
        ["list(range(1, 7, 2))", "[1, 3, 5]"],
    ),
    of(
        "repr(value)",
        "A value as it is written in a script.",
        "",
        ["repr(\"a\")", "\"\\\"a\\\"\""],
    ),
    of(
        "reversed(values)",
        "The values from the last to the first.",
        "what is no list",
        ["reversed([1, 2])", "[2, 1]"],
    ),
    of(
        "sorted(values, [key], [reverse])",
        "The values in ascending order.",
        "values that cannot be compared",
        ["sorted([3, 1])", "[1, 3]"],
    ),
    of("str(value)", "A value as text.", "", ["str(2)", "\"2\""]),
    of(
        "sum(values, [start])",
        "The sum.",
        "values that cannot be added",
        ["sum([1, 2])", "3"],
    ),
    of(
        "tuple(values)",
        "The values as a tuple.",
        "what is no list",
        ["len(tuple([1, 2]))", "2"],
    ),
    of(
        "type(value)",
        "The name of a value's type.",
        "",
        ["type(1)", "\"int\""],
    ),
];

#[cfg(test)]
mod tests {
    use std::collections::{BTreeMap, BTreeSet};

    use super::*;
    use crate::evaluate;
    use crate::language::EXPRESSION;
    use crate::mathematics::Function;

    fn all() -> impl Iterator<Item = Explained> {
        [&CONSTANTS[..], &NUMBERS[..], &STANDARD[..]]
            .concat()
            .into_iter()
    }

    #[test]
    fn every_name_is_explained_with_an_example_that_gives_what_it_says() {
        for explained in all() {
            let Explained { example, value, .. } = explained;
            let given = evaluate(example, &BTreeMap::new());
            let wanted = evaluate(value, &BTreeMap::new());
            assert_eq!(given.ok(), wanted.ok(), "{example}");
            assert!(example.contains(explained.name()) || explained.name() == "print");
            assert!(explained.summary.ends_with('.'), "{}", explained.call);
        }
        let explained: BTreeSet<&str> = all().map(|explained| explained.name()).collect();
        // What measures texts is explained with the params of texts.
        let quiet = [
            "None",
            "True",
            "False",
            "getattr",
            "dir",
            "bytes",
            "zip",
            "text_width",
        ];
        let missing: Vec<&str> = EXPRESSION
            .iter()
            .map(|global| global.0)
            .filter(|name| !name.starts_with('_') && !quiet.contains(name))
            .filter(|name| !explained.contains(name))
            .collect();
        assert_eq!(missing, Vec::<&str>::new());
    }

    #[test]
    fn calls_have_as_many_arguments_as_the_functions_take() {
        for explained in NUMBERS {
            let function = Function::named(explained.name()).expect("it is in the table");
            let (least, most) = function.arity();
            let arguments = explained.call.split_once('(').map_or("", |(_, rest)| rest);
            let arguments: Vec<&str> = arguments.trim_end_matches(')').split(", ").collect();
            let needed = arguments.iter().filter(|a| !a.starts_with(['[', '…']));
            assert_eq!(needed.count(), least, "{}", explained.call);
            assert!(arguments.contains(&"…") || arguments.len() == most);
        }
    }
}
