//! What an element inherits, and where the walk stands.

use roxmltree::{Node, NodeId};

use super::super::length::Basis;
use super::super::style::Style;
use super::window::Window;
use fretwork_geometry::Affine;

/// What an element inherits.
#[derive(Clone, Copy)]
pub struct State<'a> {
    /// From user space to spec units.
    pub map: Affine,
    /// The inherited properties.
    pub style: Style<'a>,
    /// What relative lengths are taken of.
    pub basis: Basis,
    /// Spec units per user unit of stroke width.
    pub stroke_scale: f64,
    /// The label of a `use`, for the shape that it shows.
    pub label: Option<&'a str>,
}

/// An element whose children are being visited, or a single element.
pub struct Frame<'a, 'input> {
    /// What is visited next.
    pub next: Option<Node<'a, 'input>>,
    /// Whether only `next` is visited, not its siblings.
    pub single: bool,
    /// What the `use` or the marker shows that opens the frame, until it is entered.
    pub shows: Option<NodeId>,
    /// Whether it was entered.
    pub entered: bool,
    /// What is inherited.
    pub state: State<'a>,
    /// What may hide parts of what is in the frame.
    pub windows: Vec<Window<'a, 'input>>,
}

impl<'a, 'input> Frame<'a, 'input> {
    /// All that is in `node`.
    pub fn of_children(node: Node<'a, 'input>, state: State<'a>) -> Frame<'a, 'input> {
        Frame {
            next: node.first_child(),
            single: false,
            shows: None,
            entered: false,
            state,
            windows: Vec::new(),
        }
    }

    /// Only `node`.
    pub fn of_one(node: Node<'a, 'input>, state: State<'a>) -> Frame<'a, 'input> {
        Frame {
            next: Some(node),
            single: true,
            ..Frame::of_children(node, state)
        }
    }

    /// As it is, but opened by something that shows `target`.
    pub fn showing(self, target: Node) -> Frame<'a, 'input> {
        Frame {
            shows: Some(target.id()),
            ..self
        }
    }
}
