//! One round of the structural loop (Dumas 2015, Algorithm 4): from a pattern to the voxels that must become
//! solid. The pattern is taken up again by whoever synthesizes it; that rounds follow one another is the
//! business of `structure`.

use fretwork_geometry::{Seed, budget};

use super::discretize::Detail;
use super::forces::Forces;
use super::frame::{Frame, Measure};
use super::geodesic::shorten;
use super::model::{Model, Parts};
use super::profile::{Profile, ReinforceError};
use super::select::{Selection, Stress};
use crate::connect::{AbstractGraph, Pieces, SurfaceGraph, Touch, sample, specks, widen};

/// The number of samples, as a multiple of the target, up to which stresses are computed. A pattern of
/// more pieces than that is connected by lengths first, until fewer are left.
const MODEL: usize = 3;
/// Steps of the budget for each voxel in a round.
const STEPS: u64 = 300;
/// How often the limit of the quick model is drawn tighter because the full one finds more stress.
const CORRECTIONS: usize = 3;

/// What the structural loop is to reach.
pub struct Settings<'a> {
    /// About how many samples the abstract graph has; the paper takes 1,000.
    pub samples: usize,
    /// Half the width of the pattern's features, in the surface's units: that of bridges.
    pub feature_radius: f64,
    /// The thickness of the shell, in the surface's units.
    pub thickness: f64,
    /// The forces to withstand. Without them the pattern is only connected, by the shortest bridges.
    pub profile: Option<&'a Profile<'a>>,
    /// How many times the extent of the surface the way through the pattern between two neighbours may be.
    pub geodesic_limit: Option<f64>,
    /// Pieces of fewer voxels are removed and not joined, as long as larger ones are there.
    pub least_piece: usize,
    /// The most rounds.
    pub max_iterations: usize,
    /// What the samples are drawn from.
    pub seed: Seed,
}

/// How many bridges each criterion has asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Bridges {
    /// To make the pattern one piece.
    pub connection: usize,
    /// Where the stress was too large.
    pub stress: usize,
    /// Where the way round was too long.
    pub geodesic: usize,
}

/// What one round has found.
#[derive(Clone, Debug, PartialEq)]
pub struct Round {
    /// The voxels that must be solid from now on: the bridges of this round.
    pub forced: Vec<bool>,
    /// How many bridges there are among them.
    pub bridges: Bridges,
    /// Whether there are none: the pattern is connected and meets the criteria, or comes no nearer to them.
    pub done: bool,
    /// The greatest |σ1| + |σ2| + |σ3| of the pattern's edges with the bridges, Pa, of a profile with a limit.
    pub max_stress: Option<f64>,
    /// Whether that is within the limit of the profile; without a limit, whether all else is reached.
    pub holds: bool,
    /// Samples and edges of the abstract graph.
    pub size: [usize; 2],
    /// How many solid pieces there were, specks left out.
    pub pieces: usize,
}

impl Settings<'_> {
    /// Settings of the paper for features of this radius and a shell of this thickness, without forces. Pieces
    /// smaller than a disk of half the radius are removed.
    pub fn new<'a>(feature_radius: f64, thickness: f64, pitch: f64) -> Settings<'a> {
        let half = feature_radius / pitch / 2.0;
        Settings {
            samples: 1000,
            feature_radius,
            thickness,
            profile: None,
            geodesic_limit: None,
            least_piece: (std::f64::consts::PI * half * half) as usize,
            max_iterations: 30,
            seed: Seed::root(0),
        }
    }

    /// Refuses numbers that are none.
    fn check(&self) -> Result<(), ReinforceError> {
        let limit = self.geodesic_limit.unwrap_or(1.0);
        let numbers = [
            (
                "the radius of features",
                self.feature_radius,
                self.feature_radius >= 0.0,
            ),
            ("the thickness", self.thickness, self.thickness > 0.0),
            ("the geodesic limit", limit, limit > 0.0),
        ];
        match numbers
            .into_iter()
            .find(|(_, value, fits)| !fits || !value.is_finite())
        {
            Some((name, value, _)) => Err(ReinforceError::Number { name, value }),
            None => self.profile.map_or(Ok(()), Profile::check),
        }
    }
}

/// Looks for the bridges that a pattern lacks: `solid` tells which voxels are solid, `kept` which must not be
/// taken for specks, because they have been asked for.
///
/// # Errors
/// When a number is none, or the stresses cannot be computed.
pub fn round(
    graph: &SurfaceGraph,
    solid: &[bool],
    kept: &[bool],
    settings: &Settings,
) -> Result<Round, ReinforceError> {
    settings.check()?;
    budget::spend("voxels of a pattern's graph", STEPS * graph.len() as u64);
    let surface = Pieces::of(graph, Touch::Corner, |_| true);
    let specks = specks(graph, &surface, solid, kept, settings.least_piece);
    let pattern: Vec<bool> = solid
        .iter()
        .zip(&specks)
        .map(|(s, speck)| *s && !speck)
        .collect();
    let samples = sample(graph, &pattern, settings.samples, settings.seed);
    let abstracted = AbstractGraph::new(graph, &pattern, samples);
    let mut selection = Selection::new(graph, &abstracted);
    let mut bridges = Bridges::default();
    let found = Found {
        graph,
        surface: &surface,
        pattern: &pattern,
        abstracted: &abstracted,
    };
    let stress = found.select(&mut selection, &mut bridges, settings)?;
    let paths: Vec<&Vec<u32>> = selection
        .added
        .iter()
        .map(|edge| &abstracted.edges[*edge].path)
        .collect();
    let radius = settings.feature_radius / graph.pitch();
    Ok(Round {
        forced: widen(graph, &pattern, &paths, radius),
        done: bridges == Bridges::default(),
        bridges,
        max_stress: stress.map(|stress| stress.greatest),
        holds: stress.is_none_or(|stress| stress.holds),
        size: [abstracted.samples.len(), abstracted.edges.len()],
        pieces: Pieces::of(graph, Touch::Corner, |v| pattern[v as usize]).len(),
    })
}

/// A pattern and its abstract graph.
struct Found<'a> {
    graph: &'a SurfaceGraph<'a>,
    surface: &'a Pieces,
    pattern: &'a [bool],
    abstracted: &'a AbstractGraph,
}

impl Found<'_> {
    /// Adds the edges of the three criteria, one after the other.
    fn select(
        &self,
        selection: &mut Selection,
        bridges: &mut Bridges,
        settings: &Settings,
    ) -> Result<Option<Stress>, ReinforceError> {
        let is_small = self.abstracted.samples.len() <= MODEL * settings.samples.max(1);
        let mut stress = None;
        match settings
            .profile
            .filter(|_| is_small && !self.abstracted.samples.is_empty())
        {
            Some(profile) => stress = self.withstand(selection, bridges, (settings, profile))?,
            None => selection.connect_shortest(),
        }
        if stress.is_none() {
            bridges.connection = selection.added.len();
        }
        if let Some(limit) = settings.geodesic_limit {
            let before = selection.added.len();
            shorten(self.abstracted, selection, limit * self.graph.extent());
            bridges.geodesic = selection.added.len() - before;
        }
        Ok(stress)
    }

    /// Adds the edges that connect the pattern and those that the stress asks for.
    fn withstand(
        &self,
        selection: &mut Selection,
        bridges: &mut Bridges,
        (settings, profile): (&Settings, &Profile),
    ) -> Result<Option<Stress>, ReinforceError> {
        let mut quick = self.model(settings, profile, Detail::Rigid)?;
        selection.connect(|solid| quick.scores(solid).map_err(|pad| self.mechanism(pad)))?;
        bridges.connection = selection.added.len();
        let Some(max_stress) = profile.max_stress else {
            return Ok(None);
        };
        let mut full = None;
        let mut limit = max_stress;
        for correction in 0.. {
            let found = selection.reinforce(limit, |solid| {
                quick.scores(solid).map_err(|pad| self.mechanism(pad))
            })?;
            bridges.stress = selection.added.len() - bridges.connection;
            // Whoever adds bridges comes back with another pattern; only a last look need be exact, and one before
            // the worst case by lengths: its bridges come beside those of the stress, not in place of them.
            let is_last = selection.added.is_empty() || settings.geodesic_limit.is_some();
            if !is_last && correction == 0 {
                return Ok(Some(found));
            }
            let model = match &mut full {
                Some(model) => model,
                None => full.insert(self.model(settings, profile, Detail::Full)?),
            };
            let scores = model
                .scores(&selection.solid)
                .map_err(|pad| self.mechanism(pad))?;
            let greatest = selection.greatest(&scores);
            let holds = greatest <= max_stress;
            if holds || !found.holds || correction == CORRECTIONS {
                return Ok(Some(Stress { greatest, holds }));
            }
            limit = found.greatest * (max_stress / greatest).min(0.99);
        }
        Ok(None)
    }

    fn model(
        &self,
        settings: &Settings,
        profile: &Profile,
        detail: Detail,
    ) -> Result<Model, ReinforceError> {
        let thickness = settings.thickness * profile.metres;
        let measure = Measure {
            pitch: self.graph.pitch() * profile.metres,
            thickness,
            bridge: (2.0 * settings.feature_radius + self.graph.pitch()) * profile.metres,
        };
        let frame = Frame::new(self.graph, self.abstracted, &measure);
        let pattern = (self.pattern, thickness);
        let forces = Forces::new(self.graph, self.surface, self.abstracted, profile, pattern)?;
        let solid: Vec<bool> = self
            .abstracted
            .edges
            .iter()
            .map(|edge| edge.is_solid)
            .collect();
        let parts = Parts::new(&frame, &forces, profile, &solid, detail);
        Model::new(parts).map_err(|_| self.mechanism(0))
    }

    /// The error of a pad that can move.
    fn mechanism(&self, pad: usize) -> ReinforceError {
        let place = self.graph.center(self.abstracted.samples[pad]);
        ReinforceError::Mechanism { place }
    }
}
