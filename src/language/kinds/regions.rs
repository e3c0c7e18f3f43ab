//! `regions`: areas of the plane.

use crate::Ref;
use crate::kinds::texts::Letters;
use crate::macros::{choice, kinds, record};
use crate::placement::PlanePlacement;
use crate::scalar::{Count, FilePath, Label, Length, NonNegativeLength, PositiveLength, Text};
use crate::types::wants;
use crate::value::{Direction, Named, NonEmpty, OneOrMany, SpacePoint, TableValue};

kinds! {
    /// Areas of the plane: polygons with holes, whose faces may carry labels and attributes. A region stands wherever an
    /// arrangement does, and a cutout, by the shape in which it is cut flat, wherever a region does.
    pub enum Region {
        /// A rectangle with sides along the axes; `at` is its lower-left corner.
        rectangle: Rectangle(Rectangle),
        /// A disc; `at` is its centre.
        circle: Circle(Circle),
        /// What a drawing encloses: the inside of its filled shapes, and what its lines cut off from the outside. Strokes have no width here; a ring of lines inside of others makes no hole, but a hole of what is filled stays one when it is outlined.
        svg: Svg(Svg),
        /// Letters: in lines, aligned, fitted to a width, along a curve, as a stencil.
        text: Text(Letters),
        /// A region whose border is moved inward, or outward.
        inset: Inset(Inset),
        /// Faces of an arrangement.
        faces: Faces(Faces),
        /// What of a solid lies in a plane, seen from the side of its normal: from above as it was drawn, from a side with z up. A
        /// facade stands upright, as in its elevation.
        section: Section(Section),
        /// A solid as sheets to be stacked: its sections side by side, in rows, each with its number as its label.
        slices: Slices(Slices),
        /// What is in any of the regions.
        union: Union(NonEmpty<Ref<wants::Region>>),
        /// What is in all of the regions.
        intersection: Intersection(NonEmpty<Ref<wants::Region>>),
        /// What is in the first region and in none of the others.
        difference: Difference(NonEmpty<Ref<wants::Region>>),
        /// The polygons of a map: Shapefile, GeoJSON or GeoPackage, in the units of the map. Attributes become labels and fields.
        geodata: Geodata(Geodata),
    }
}

record! {
    /// A rectangle with sides along the axes; `at` is its lower-left corner.
    pub struct Rectangle {
        /// Its extent along x.
        width: PositiveLength,
        /// Its extent along y.
        height: PositiveLength,
        /// Opposite sides join, which makes seamless tiles.
        periodic: bool = false,
    }
    /// Where it stands.
    + placement: PlanePlacement
}

record! {
    /// A disc; `at` is its centre.
    pub struct Circle {
        /// Its radius.
        radius: PositiveLength,
    }
    /// Where it stands.
    + placement: PlanePlacement
}

record! {
    /// The shapes of an SVG file.
    pub struct Svg {
        /// The drawing.
        file: FilePath,
        /// The element to take, by its label or id, with all that is inside it. Without it, the whole drawing.
        id: Option<Text>,
    }
    /// Where it stands.
    + placement: PlanePlacement
}

record! {
    /// A region moved inward.
    pub struct Inset {
        /// The region.
        from: Ref<wants::Region>,
        /// How far its border moves inward; outward where it is below 0.
        by: Length,
        /// The radius of the rounding of its corners.
        corner_radius: NonNegativeLength = 0,
    }
}

record! {
    /// The bounded faces of an arrangement as one region; of a region or a cutout the parts that it fills, without its holes.
    pub struct Faces {
        /// The arrangement.
        of: Ref<wants::Arrangement>,
        /// The region that it is drawn on, or that cuts off what lies outside of it.
        region: Ref<wants::Region>,
        /// The faces that are taken: those with any of these labels. Without it, all.
        r#where: Option<OneOrMany<Label>>,
        /// How far the outline of each face moves inward; outward where it is below 0. Where it is 0, faces beside each other are
        /// one.
        inset: Length = 0,
    }
}

record! {
    /// What of a solid lies in a plane.
    pub struct Section {
        /// The solid, which must be closed.
        of: Ref<wants::Solid>,
        /// The plane.
        plane: Plane,
    }
}

record! {
    /// A plane. What lies in it is drawn where it is seen from the side of the normal, and not moved to `at`.
    pub struct Plane {
        /// A point of it.
        at: SpacePoint = [0, 0, 0],
        /// The direction that it is seen from, square to it.
        normal: Direction = [0, 0, 1],
    }
}

record! {
    /// A solid as sheets to be stacked.
    pub struct Slices {
        /// The solid, which must be closed.
        of: Ref<wants::Solid>,
        /// The axis that the sheets are stacked along; the first lies lowest on it.
        along: StackAxis = "z",
        /// How thick a sheet is. Each has the section in the middle of what of the solid lies in it; a last sheet that is not
        /// filled is told.
        every: PositiveLength,
        /// Between slices side by side.
        gap: NonNegativeLength = 2,
        /// How many stand in a row. Without it the sheet becomes about square.
        columns: Option<Count>,
        /// The diameter of holes for two pins through all slices; none where it is 0.
        pins: NonNegativeLength = 0,
    }
}

choice! {
    /// An axis that sheets are stacked along.
    pub enum StackAxis {
        /// From left to right.
        x: X,
        /// From front to back.
        y: Y,
        /// From below upward.
        z: Z,
    }
}

record! {
    /// The polygons of a map, in the units of the map.
    pub struct Geodata {
        /// The map: `.shp`, `.geojson`, `.json` or `.gpkg`.
        file: FilePath,
        /// The layer to take, where the file has several.
        layer: Option<Text>,
        /// The columns of the table whose texts become labels: of faces for polygons, of edges for lines, of vertices for points.
        labels: Option<OneOrMany<Text>>,
        /// Take only those features whose columns hold the value, or one of the values, that is given here; `null` takes those without one.
        r#where: Option<Named<OneOrMany<TableValue>>>,
    }
    /// Where it stands.
    + placement: PlanePlacement
}
