//! Cells moved, turned and scaled one by one as a spec declares it.

use crate::cells::{Cell, contour, to_curve};
use crate::error::ArrangementError;
use fretwork_geometry::budget;
use fretwork_geometry::drawing::Join;
use fretwork_geometry::planar_map::{FaceId, PlanarMap};
use fretwork_geometry::polygon::{of_face, offset};
use fretwork_geometry::{Affine, CurveLabels, Curves, Point, Polygon};
use fretwork_language::kinds::arrangements::{ExtendedCells, Transform};
use fretwork_language::placement::{PlaneAxis, PlaneRepeat};

/// Corners of an inset contour are sharp up to this many times its distance.
const MITER: f64 = 4.0;

/// Bytes for a point of a copy: those of the point, as many for the labels of its curve, and as many for whoever copies the
/// whole.
const COPIED: usize = 3 * size_of::<Point>();

/// The contours of the bounded faces of `map`, or its edges, each transformed about the centre of
/// its own box: moved inward (faces only), scaled, mirrored, turned, moved, in this order.
///
/// An inset contour is one closed curve per ring, with the labels of the face inside; the labels of
/// its edges and vertices are lost. What gets thinner than nothing vanishes.
///
/// # Errors
/// When a face is too large or too small for its inset to be computed.
pub fn transform(
    map: &PlanarMap,
    kind: &Transform,
    resolution: f64,
) -> Result<Curves, ArrangementError> {
    let cells: Vec<Cell> = match kind.cells {
        ExtendedCells::Edges(_) => map.edges().map(Cell::Edge).collect(),
        ExtendedCells::Faces(_) => map.bounded_faces().map(Cell::Face).collect(),
    };
    transform_at(map, kind, resolution, &cells)
}

/// The same of some of the cells.
///
/// # Errors
/// Those of [`transform`].
pub(crate) fn transform_at(
    map: &PlanarMap,
    kind: &Transform,
    resolution: f64,
    cells: &[Cell],
) -> Result<Curves, ArrangementError> {
    let cells = outlines(map, kind, resolution, cells)?;
    let copies = kind.repeat.map_or(1, |PlaneRepeat(repeat)| repeat.count());
    let count = |of: fn(&Curves) -> usize| {
        let all: usize = cells.iter().map(of).sum();
        all.saturating_mul(copies)
    };
    let points = count(|cell| cell.points().len());
    budget::hold("points of copies", points, COPIED);
    budget::spend("points of copies", points as u64);
    // What grows bit by bit takes twice its memory each time that it is moved to a larger place.
    let mut curves = Curves::with_capacity(count(Curves::len), points);
    for cell in &cells {
        append_moved(cell, kind, &mut curves);
    }
    Ok(curves)
}

/// The cells that are moved as curves, one after another.
fn outlines(
    map: &PlanarMap,
    kind: &Transform,
    resolution: f64,
    cells: &[Cell],
) -> Result<Vec<Curves>, ArrangementError> {
    let of_face = |f: FaceId| match kind.inset.0 {
        0.0 => Ok(contour(map, f)),
        by => inset_contour(map, f, by, resolution),
    };
    let outline = |cell: &Cell| match *cell {
        Cell::Edge(e) => Ok(to_curve(map, e)),
        Cell::Face(f) => of_face(f),
        Cell::Vertex(_) => Ok(Curves::new()),
    };
    cells.iter().map(outline).collect()
}

fn inset_contour(
    map: &PlanarMap,
    f: FaceId,
    by: f64,
    resolution: f64,
) -> Result<Curves, ArrangementError> {
    let mut curves = Curves::new();
    let labels = CurveLabels {
        left: map.face_labels(f),
        ..CurveLabels::default()
    };
    for polygon in inset(map, f, by, resolution)? {
        for ring in polygon.rings() {
            curves.push(ring.iter().chain(ring.first()).copied(), labels);
        }
    }
    Ok(curves)
}

/// The area of a face moved inward by `by`.
///
/// # Errors
/// When the face is too large or too small for that.
pub(crate) fn inset(
    map: &PlanarMap,
    f: FaceId,
    by: f64,
    resolution: f64,
) -> Result<Vec<Polygon>, ArrangementError> {
    let mut area = offset(&of_face(map, f), -by, Join::Miter(MITER), resolution)?;
    // What is as thin as the grid of a planar map would come out of it as an open line.
    let is_thick = |polygon: &Polygon| {
        let around: f64 = polygon.outer.windows(2).map(|w| w[0].distance(w[1])).sum();
        polygon.area() > 4.0 * resolution * around
    };
    area.retain(is_thick);
    Ok(area)
}

/// Adds the copies of one cell.
fn append_moved(cell: &Curves, kind: &Transform, all: &mut Curves) {
    let bounds = cell.bounds();
    if bounds.is_empty() {
        return all.append(cell);
    }
    let center = bounds.center();
    let [x, y] = kind.scale.0;
    let mirror = match kind.mirror {
        Some(PlaneAxis::X) => Affine::scale(-1.0, 1.0),
        Some(PlaneAxis::Y) => Affine::scale(1.0, -1.0),
        None => Affine::IDENTITY,
    };
    let first = Affine::scale(x, y)
        .then(mirror)
        .then(Affine::rotation(kind.rotate.0))
        .then(Affine::translation(Point::from(kind.at.0)));
    let Some(PlaneRepeat(repeat)) = kind.repeat else {
        return all.append(&cell.transformed(&first.about(center)));
    };
    for (angle, [x, y, _]) in repeat.copies() {
        let copy = Affine::rotation(angle).then(Affine::translation(Point::new(x, y)));
        all.append(&cell.transformed(&first.then(copy).about(center)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::planar_map::resolution;
    use fretwork_geometry::{LabelSet, Region};
    use fretwork_language::Ref;
    use fretwork_language::placement::{PlaneScale, Repeat};
    use fretwork_language::scalar::{Angle, Length};
    use fretwork_language::value::PlanePoint;

    #[test]
    fn faces_shrink_about_their_middles_and_keep_their_labels() {
        let page =
            Region::rectangle(Point::ORIGIN, Point::new(8.0, 4.0)).labelled(LabelSet::one("page"));
        let map = PlanarMap::build(&page.contour, resolution(8.0)).unwrap();
        let mut kind = Transform {
            inset: Length(0.0),
            scale: PlaneScale([0.5, 0.5]),
            mirror: Some(PlaneAxis::X),
            rotate: Angle(std::f64::consts::FRAC_PI_2),
            at: PlanePoint([100.0, 0.0]),
            repeat: None,
            cells: ExtendedCells::Faces(Ref::new("page")),
        };
        let at = |kind: &Transform| transform(&map, kind, resolution(8.0)).unwrap();
        let moved = PlanarMap::build(&at(&kind), resolution(8.0)).unwrap();
        assert_eq!((moved.face_count(), moved.vertex_count()), (1, 4));
        assert!(
            (moved.area() - 8.0).abs() < 1e-9
                && moved.centroid(FaceId(1)).distance(Point::new(104.0, 2.0)) < 1e-9
        );
        assert!(moved.face_labels(FaceId(1)).contains("page"));
        kind = Transform {
            inset: Length(1.0),
            scale: PlaneScale([1.0, 1.0]),
            ..kind
        };
        let inset = PlanarMap::build(&at(&kind), resolution(8.0)).unwrap();
        assert!(
            (inset.area() - 12.0).abs() < 1e-6 && inset.face_labels(FaceId(1)).contains("page")
        );
        kind.inset = Length(2.5);
        assert!(at(&kind).is_empty());
        kind = Transform {
            inset: Length(0.0),
            cells: ExtendedCells::Edges(Ref::new("page")),
            ..kind
        };
        assert_eq!(at(&kind).len(), 4);
        let quarters = Repeat::Turn {
            count: 4,
            angle: std::f64::consts::FRAC_PI_2,
        };
        let (cells, place) = (
            ExtendedCells::Faces(Ref::new("page")),
            PlanePoint([20.0, 0.0]),
        );
        kind = Transform {
            cells,
            at: place,
            repeat: Some(PlaneRepeat(quarters)),
            ..kind
        };
        let round = at(&kind).bounds();
        // The middle of the page is (4, 2), and each copy 8 long across the way out.
        assert!(
            round.center().distance(Point::new(4.0, 2.0)) < 1e-9
                && (round.width() - 44.0).abs() < 1e-9
        );
    }
}
