//! `partitions`: arrangements that divide a region into cells.

use crate::macros::{choice, kinds, record};
use crate::scalar::{Angle, Density, NonNegativeLength, PositiveLength, PositiveNumber, Scale};
use crate::types::wants;
use crate::value::{LabelCycle, OneOrMany, Range, Varying, WeightedLabels};
use crate::{Anchor, Ref, Tree};

kinds! {
    /// Arrangements that divide a region into cells, from which others are built. Lengths and positions are those of the region that is divided.
    pub enum Partition {
        /// Parallel lines. The first stripe is centred on the region's lower-left corner; at an angle of 0 the lines run along x.
        stripes: Stripes(AnchoredStripes),
        /// Two families of parallel lines. A cell has the labels of both of its stripes.
        grid: Grid(Grid),
        /// The Voronoi cells of evenly spread random points (a Poisson-disk set).
        uniform: Uniform(Voronoi),
        /// The Voronoi cells of independent random points (a Poisson process).
        random: Random(Voronoi),
        /// As many copies of elements as fit without overlap.
        packed: Packed(Packed),
        /// The lines on which a field has a multiple of a value. Edges are labelled with the value. Where a field of samples has
    /// more than 2048 across, lines are divided there.
        isolines: Isolines(Isolines),
    }
}

choice! {
    /// What happens to cells and elements at the border of the region.
    pub enum Border {
        /// They are cut at the border.
        crop: Crop,
        /// They are cut at the border, and the border itself is added.
        crop_add_boundary: CropAddBoundary,
        /// Those that lie wholly inside are kept, uncut.
        keep_inside: KeepInside,
        /// Those that lie inside in part are kept as well, uncut.
        keep_outside: KeepOutside,
    }
}

record! {
    /// Parallel lines. The first stripe is centred on the anchor; at an angle of 0 the lines run along x.
    pub struct AnchoredStripes {
        /// The point of the plane that the first stripe is centred on. With `origin` or a point, neighbouring regions match.
        anchor: Anchor = "region",
    }
    /// The lines.
    + lines: Stripes
}

record! {
    /// Parallel lines. The first stripe is centred on the region's lower-left corner; at an angle of 0 the lines run along x.
    pub struct Stripes {
        /// The direction of the lines, from +x toward +y. A field is read at the centroid of the region that is divided.
        angle: Varying<Angle> = 0,
        /// The widths of the stripes, in turn.
        spacing: OneOrMany<Varying<PositiveLength>>,
        /// The labels of the lines, in turn.
        edge_labels: LabelCycle = Tree::list([]),
        /// The labels of the stripes, in turn.
        face_labels: LabelCycle = Tree::list([]),
    }
}

record! {
    /// Two families of parallel lines. A cell has the labels of both of its stripes.
    pub struct Grid {
        /// The first family.
        across: Stripes,
        /// The second family.
        along: Stripes,
        /// What happens at the border.
        border: Border = "crop",
        /// The point of the plane that the first cell is centred on. With `origin` or a point, neighbouring regions match.
        anchor: Anchor = "region",
    }
}

record! {
    /// Voronoi cells of random points. They are parts of one pattern of the whole plane, which depends on the seed and the
    /// density alone: regions that overlap show the same cells, and where a density field changes, cells change no farther
    /// away than a few times their width.
    pub struct Voronoi {
        /// What happens at the border.
        border: Border = "crop",
        /// Without effect: the cells are parts of one pattern of the plane, and neighbouring regions match.
        anchor: Anchor = "region",
        /// The labels of the corners.
        vertex_labels: WeightedLabels = Tree::list([]),
        /// The labels of the sides.
        edge_labels: WeightedLabels = Tree::list([]),
        /// The labels of the cells.
        face_labels: WeightedLabels = Tree::list([]),
    }
    /// How many cells there are.
    + amount: CellAmount
}

kinds! {
    /// How many cells there are.
    pub enum CellAmount {
        /// The mean number of cells per square unit.
        density: Density(Varying<Density>),
        /// The side of a square of the cells' mean area: the density is 1/cell_size².
        cell_size: CellSize(Varying<PositiveLength>),
    }
}

record! {
    /// Copies of elements that do not overlap.
    pub struct Packed {
        /// What is copied; drawn at random from a list.
        elements: OneOrMany<Ref<wants::VectorExemplar>>,
        /// How far a copy is turned; `[least, greatest]` is drawn at random.
        rotate: Range<Angle> = 0,
        /// A factor; `[least, greatest]` is drawn at random, larger ones first.
        scale: Range<Scale> = 1,
        /// The least distance between copies.
        gap: NonNegativeLength = 0,
        /// With `origin` or a point, the copies are those of one packing of the whole plane that come into the region, uncut:
        /// neighbouring regions match. Otherwise they lie inside of the region.
        anchor: Anchor = "region",
    }
}

record! {
    /// The lines on which a field has a multiple of a value. Edges are labelled with the value. Where a field of samples has
    /// more than 2048 across, lines are divided there.
    pub struct Isolines {
        /// The field.
        field: Ref<wants::Field>,
        /// The difference from one line to the next, in the field's unit.
        every: PositiveNumber,
    }
}
