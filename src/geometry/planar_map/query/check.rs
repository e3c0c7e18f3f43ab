//! What must hold of every planar map. Called by tests, by the fuzz target, and on every map with
//! `FRETWORK_CHECK=1`; it is slow compared with building the map, but not quadratic.

use crate::numeric::UnionFind;
use crate::planar_map::noding::bins::{Bins, Cells};
use crate::planar_map::noding::exact::{Segment, cross, crossing};
use crate::planar_map::noding::snap_grid::Site;
use crate::planar_map::{FaceId, PlanarMap};

impl PlanarMap {
    /// Whether the map is consistent, or a sentence on the first thing that is not: half-edges, their order
    /// around vertices and faces, Euler's formula, that pieces meet at nodes only and are
    /// farther than the resolution from all other nodes, areas, labels, sources.
    pub fn check(&self) -> Result<(), String> {
        self.check_half_edges()?;
        self.check_rotation()?;
        self.check_faces()?;
        self.check_labels()?;
        self.check_noded()
    }

    fn check_half_edges(&self) -> Result<(), String> {
        let (v, e, f, c) = (
            self.vertex_count() - self.lone_vertices().count(),
            self.edge_count(),
            self.face_count(),
            self.component_count(),
        );
        ensure(v + f == e + c, || format!("{v} - {e} + {f} is not {c}"))?;
        let mut met = vec![false; 2 * e];
        for (h, &n) in self.next.iter().enumerate() {
            let target = self.ends[h / 2][1 - h % 2];
            let origin = self.ends[n as usize / 2][n as usize % 2];
            ensure(target == origin, || {
                format!("half-edge {h} ends at {target}, its successor begins at {origin}")
            })?;
            ensure(self.faces.of[h] == self.faces.of[n as usize], || {
                format!("face changes after half-edge {h}")
            })?;
            ensure(!std::mem::replace(&mut met[n as usize], true), || {
                format!("half-edge {n} follows two")
            })?;
        }
        let joined = components(&self.ends, v);
        ensure(joined == c, || format!("{c} components are {joined}"))
    }

    fn check_rotation(&self) -> Result<(), String> {
        let mut leaving = 0;
        for v in self.vertices() {
            let star: Vec<Site> = self
                .outgoing(v)
                .map(|h| {
                    let sites: Vec<Site> = self
                        .half_edge_points(h)
                        .iter()
                        .map(|p| self.grid.snap(*p))
                        .collect();
                    [sites[1][0] - sites[0][0], sites[1][1] - sites[0][1]]
                })
                .collect();
            leaving += star.len();
            // Counter-clockwise once round: exactly one step turns past the first direction.
            let half = |d: Site| d[1] < 0.0 || (d[1] == 0.0 && d[0] < 0.0);
            let ascends = |a: Site, b: Site| (half(a), 0.0) < (half(b), cross(a, b));
            let falls = (0..star.len())
                .filter(|&i| !ascends(star[i], star[(i + 1) % star.len()]))
                .count();
            ensure(falls == 1 || star.is_empty(), || {
                format!("the edges around {v:?} are not in order: {star:?}")
            })?;
        }
        ensure(leaving == 2 * self.edge_count(), || {
            format!("{leaving} half-edges leave vertices")
        })
    }

    fn check_faces(&self) -> Result<(), String> {
        let (mut seen, mut total) = (0, 0.0);
        for f in std::iter::once(FaceId::UNBOUNDED).chain(self.bounded_faces()) {
            for h in self
                .outer_boundary(f)
                .chain(self.inner_boundaries(f).flatten())
            {
                ensure(self.face(h) == f, || {
                    format!("{h:?} on the boundary of {f:?} is of another face")
                })?;
                seen += 1;
            }
            if f != FaceId::UNBOUNDED {
                let area = self.face_area(f);
                ensure(area > 0.0, || format!("{f:?} has area {area}"))?;
                total += area;
            }
        }
        ensure(seen == 2 * self.edge_count(), || {
            format!("{seen} half-edges bound faces")
        })?;
        let outside: f64 = self
            .inner_boundaries(FaceId::UNBOUNDED)
            .map(|c| self.enclosed(c))
            .sum();
        let reach = crate::Bounds::of(self.points.iter().chain(&self.inner).copied());
        let rounding = 1e-12 * (reach.width() + reach.height()).powi(2);
        ensure((total + outside).abs() <= rounding, || {
            format!("faces cover {total} of {}", -outside)
        })
    }

    /// The signed area that a cycle goes round.
    fn enclosed(&self, cycle: impl Iterator<Item = crate::planar_map::HalfEdge>) -> f64 {
        let mut ring: Vec<_> = cycle.flat_map(|h| self.half_edge_points(h)).collect();
        ring.dedup();
        crate::polygon::signed_area(&ring)
    }

    fn check_labels(&self) -> Result<(), String> {
        ensure(self.face_labels(FaceId::UNBOUNDED).is_empty(), || {
            "the unbounded face is labelled".into()
        })?;
        for e in self.edges() {
            let labels = self.labels(e);
            for (carried, f) in [(labels.left, self.left(e)), (labels.right, self.right(e))] {
                let missing = f != FaceId::UNBOUNDED
                    && self.face_labels(f).union(carried) != self.face_labels(f);
                ensure(!missing, || {
                    format!("{f:?} lacks labels {carried:?} of {e:?}")
                })?;
            }
            for (carried, v) in [(labels.start, self.source(e)), (labels.end, self.target(e))] {
                let all = self.vertex_labels(v);
                ensure(all.union(carried) == all, || {
                    format!("{v:?} lacks labels {carried:?} of {e:?}")
                })?;
            }
            let sources: Vec<_> = self.sources(e).collect();
            ensure(sources.is_sorted() && !sources[0].reversed, || {
                format!("sources of {e:?}: {sources:?}")
            })?;
        }
        Ok(())
    }

    fn check_noded(&self) -> Result<(), String> {
        let mut segments = Vec::new();
        for e in self.edges() {
            let sites: Vec<Site> = self.points(e).map(|p| self.grid.snap(p)).collect();
            for w in sites.windows(2) {
                ensure(w[0] != w[1], || format!("{e:?} has a piece of no length"))?;
                segments.push(Segment::between(w[0], w[1]).0);
            }
        }
        if segments.is_empty() {
            return Ok(());
        }
        let bins = Bins::fill(Cells::suited(&segments), segments.len(), |i| segments[i]);
        for cell in 0..bins.cells.len() {
            let members = bins.members(cell);
            for (k, &i) in members.iter().enumerate() {
                for &j in &members[k + 1..] {
                    apart(&segments[i as usize], &segments[j as usize])?;
                }
            }
        }
        Ok(())
    }
}

/// Whether two pieces have at most an end in common and keep their distance otherwise.
fn apart(s: &Segment, t: &Segment) -> Result<(), String> {
    ensure(crossing(s, t).is_none(), || format!("{s:?} crosses {t:?}"))?;
    for (p, q) in [(s, t), (t, s)] {
        for end in [p.a, p.b] {
            let free = end != q.a && end != q.b;
            ensure(
                !free || q.distance(end) > crate::planar_map::noding::candidate::REACH,
                || format!("{end:?} is on {q:?}"),
            )?;
        }
    }
    ensure(s != t, || format!("{s:?} comes twice"))
}

fn ensure(holds: bool, sentence: impl FnOnce() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(sentence()) }
}

/// How many components the edges join the vertices to.
fn components(ends: &[[u32; 2]], vertices: usize) -> usize {
    let mut sets = UnionFind::new(vertices);
    for &[a, b] in ends {
        sets.unite(a, b);
    }
    sets.count()
}
