//! The tasks of a plan: what each needs, makes and does.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::plan::Plan;
use super::scene::Scene;
use super::tile::Tile;
use edifice_base::{Error, Result, Watch, file};
use edifice_city_proceduralization::country::{Sample, Stands, code, merge, propose};
use edifice_frame::provenance;
use edifice_grammar::instance::Kept;
use edifice_io_city::compact::{self, DICTIONARY};
use edifice_io_city::proposal_json::{self, Proposal};
use edifice_io_city::{self as city, tiles};
use edifice_shape::triangles::City;

/// A task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Task {
    /// A tile proposes types.
    Propose(usize),
    /// All proposals become the dictionary.
    Merge,
    /// A tile becomes a grammar over the dictionary.
    Code(usize),
    /// A tile's grammar becomes 3D Tiles.
    Scene(usize),
    /// One tileset refers to those of all tiles.
    Index,
}

/// A tile that is not what it was.
#[derive(Debug, thiserror::Error)]
#[error("the tile has changed since the plan was made; run `edifice city plan`")]
struct Changed;

/// A plan with the folders of its results.
pub(super) struct Place<'a> {
    pub(super) plan: &'a Plan,
    pub(super) out: &'a Path,
    /// Proposals, claims, times.
    pub(super) work: PathBuf,
    /// Results.
    city: PathBuf,
}

impl<'a> Place<'a> {
    pub(super) fn new(plan: &'a Plan, out: &'a Path) -> Self {
        Self {
            plan,
            out,
            work: out.join(format!("work-{}", plan.key)),
            city: out.join(format!("city-{}", plan.key)),
        }
    }

    /// All tasks, each after those that it needs.
    pub(super) fn tasks(&self) -> Vec<Task> {
        let tiles = 0..self.plan.tiles.len();
        let mut tasks: Vec<Task> = tiles.clone().map(Task::Propose).collect();
        tasks.push(Task::Merge);
        tasks.extend(tiles.clone().map(Task::Code));
        if self.plan.settings.scenes {
            tasks.extend(tiles.map(Task::Scene));
            tasks.push(Task::Index);
        }
        tasks
    }

    /// A name of a task for its claim and its time.
    pub(super) fn name(&self, task: Task) -> String {
        let tile = |t: usize| &self.plan.tiles[t].name;
        match task {
            Task::Propose(t) => format!("propose-{}", tile(t)),
            Task::Merge => "merge".to_owned(),
            Task::Code(t) => format!("code-{}", tile(t)),
            Task::Scene(t) => format!("scene-{}", tile(t)),
            Task::Index => "index".to_owned(),
        }
    }

    /// The file that is there when the task is finished.
    pub(super) fn output(&self, task: Task) -> PathBuf {
        let tile = |t: usize| &self.plan.tiles[t].name;
        let scenes = self.city.join("3dtiles");
        match task {
            Task::Propose(t) => {
                let name = format!("{}.city-proposal.json.gz", tile(t));
                self.work.join("proposals").join(name)
            }
            Task::Merge => self.city.join(DICTIONARY),
            Task::Code(t) => self.city.join(format!("{}.city-grammar.bin", tile(t))),
            Task::Scene(t) => scenes.join(tile(t)).join("tileset.json"),
            Task::Index => scenes.join("tileset.json"),
        }
    }

    /// The tasks that have to be finished first.
    pub(super) fn needs(&self, task: Task) -> Vec<Task> {
        let tiles = 0..self.plan.tiles.len();
        match task {
            Task::Propose(_) => Vec::new(),
            Task::Merge => tiles.map(Task::Propose).collect(),
            Task::Code(_) => vec![Task::Merge],
            Task::Scene(t) => vec![Task::Code(t)],
            Task::Index => tiles.map(Task::Scene).collect(),
        }
    }

    /// Does a task, and writes its file.
    ///
    /// # Errors
    /// Those of reading, of the method and of writing.
    pub(super) fn run(&self, task: Task, watch: &Watch) -> Result<()> {
        let output = self.output(task);
        let folder = output.parent().unwrap_or(self.out);
        std::fs::create_dir_all(folder).map_err(|e| Error::io(folder, "create", e))?;
        let bytes = match task {
            Task::Propose(t) => self.propose(&self.plan.tiles[t], watch)?,
            Task::Merge => self.merge(watch)?,
            Task::Code(t) => self.code(t, watch)?,
            Task::Scene(t) => self.scene(t, folder)?,
            Task::Index => self.index()?,
        };
        file::write_atomic(&output, &bytes)
    }

    fn tile(&self, tile: &Tile) -> Result<(City, PathBuf)> {
        let path = self.out.join(&tile.path);
        match provenance::digest(&path)? == tile.sha256 {
            true => Ok((city::read(&path)?, path)),
            false => Err(Error::content(&path, Changed)),
        }
    }

    fn propose(&self, tile: &Tile, watch: &Watch) -> Result<Vec<u8>> {
        let (city, path) = self.tile(tile)?;
        let sample = propose(&city, &self.plan.settings()?, watch);
        let sample = sample.map_err(|e| Error::content(&path, e))?;
        let proposal = Proposal {
            components: sample.components,
            stands: sample.stands.iter().map(|s| [s.count, s.volume]).collect(),
            grammar: sample.grammar,
        };
        proposal_json::to_bytes(&proposal).map_err(Error::method)
    }

    fn proposal(&self, tile: usize) -> Result<Sample> {
        let read = proposal_json::read(&self.output(Task::Propose(tile)))?;
        let stands = read.stands.into_iter();
        Ok(Sample {
            components: read.components,
            stands: stands
                .map(|[count, volume]| Stands { count, volume })
                .collect(),
            grammar: read.grammar,
        })
    }

    fn merge(&self, watch: &Watch) -> Result<Vec<u8>> {
        let proposals = (0..self.plan.tiles.len()).map(|t| self.proposal(t));
        let proposals: Vec<Sample> = proposals.collect::<Result<_>>()?;
        let merged = merge(&proposals, &self.plan.settings()?, watch);
        let merged = merged.map_err(Error::method)?;
        compact::to_bytes(&merged.grammar).map_err(Error::method)
    }

    fn code(&self, tile: usize, watch: &Watch) -> Result<Vec<u8>> {
        let path = self.output(Task::Merge);
        let dictionary = compact::dictionary(&file::read_bytes(&path)?);
        let dictionary = dictionary.map_err(|e| Error::content(&path, e))?;
        let proposal = self.proposal(tile)?;
        let (city, path) = self.tile(&self.plan.tiles[tile])?;
        let settings = self.plan.settings()?;
        let grammar = code(&city, &dictionary.grammar, &proposal, &settings, watch);
        let mut grammar = grammar.map_err(|e| Error::content(&path, e))?;
        if !self.plan.settings.attributes {
            grammar = grammar.keeping(Kept::Identifiers);
        }
        compact::to_bytes_over(&grammar, &dictionary).map_err(|e| Error::content(&path, e))
    }

    /// Writes the tiles of a tile's scene; the bytes of its tileset.
    fn scene(&self, tile: usize, folder: &Path) -> Result<Vec<u8>> {
        let path = self.output(Task::Code(tile));
        let grammar = compact::read(&path)?.keeping(Kept::Buildings);
        let grammar = grammar.without_unused_templates();
        let derivation = grammar.derive().map_err(|e| Error::content(&path, e))?;
        // The index puts it in its place.
        let mut settings = tiles::Settings::default();
        settings.on_the_earth = false;
        let files = tiles::to_files(&grammar, &derivation, &settings);
        let mut files = files.map_err(|e| Error::content(&path, e))?;
        let last = files.pop().map(|f| f.1).unwrap_or_default();
        for (name, bytes) in &files {
            file::write_atomic(&folder.join(name), bytes)?;
        }
        Ok(last)
    }

    /// The tileset over those of all tiles: on the earth, where all their reference systems are known, else at the origin of the first.
    fn index(&self) -> Result<Vec<u8>> {
        let mut scenes = Vec::new();
        for t in 0..self.plan.tiles.len() {
            let path = self.output(Task::Scene(t));
            let read: Value = serde_json::from_slice(&file::read_bytes(&path)?)
                .map_err(|e| Error::content(&path, e))?;
            let scene = Scene::new(&read);
            scenes.push(scene.ok_or_else(|| Error::content(&path, "no tileset of this program"))?);
        }
        let on_the_earth: Option<Vec<[f64; 16]>> = scenes.iter().map(Scene::on_the_earth).collect();
        let is_on_the_earth = on_the_earth.is_some();
        let origin = scenes.first().map_or([0.0; 3], |s| s.origin);
        let places = on_the_earth.unwrap_or_else(|| {
            let beside = |s: &Scene| {
                let [x, y, z] = [0, 1, 2].map(|k| s.origin[k] - origin[k]);
                [
                    1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, x, y, z, 1.0,
                ]
            };
            scenes.iter().map(beside).collect()
        });
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let (mut children, mut error) = (Vec::new(), 0.0f64);
        for ((tile, scene), place) in self.plan.tiles.iter().zip(&scenes).zip(&places) {
            for corner in scene.corners() {
                for k in 0..3 {
                    let axes = (0..3).map(|axis| place[4 * axis + k] * corner[axis]);
                    let v = axes.sum::<f64>() + place[12 + k];
                    low[k] = low[k].min(v);
                    high[k] = high[k].max(v);
                }
            }
            error = error.max(scene.error);
            children.push(json!({
                "transform": place, "boundingVolume": { "box": scene.cube }, "geometricError": scene.error,
                "refine": "REPLACE", "content": { "uri": format!("{}/tileset.json", tile.name) },
            }));
        }
        let half = [0, 1, 2].map(|k| (high[k] - low[k]) / 2.0);
        let middle = [0, 1, 2].map(|k| (high[k] + low[k]) / 2.0);
        let error = error.max(half.iter().sum());
        let region = || {
            let all = scenes.iter().zip(&places);
            let regions = all.map(|(scene, place)| scene.region(place));
            regions.reduce(|a, b| a.union(&b))
        };
        let volume = match is_on_the_earth.then(region).flatten() {
            Some(region) => json!({ "region": region.numbers() }),
            None => {
                json!({ "box": [middle[0], middle[1], middle[2], half[0], 0, 0, 0, half[1], 0, 0, 0, half[2]] })
            }
        };
        let tileset = json!({
            "asset": { "version": "1.1", "extras": { "unit": "m", "up": "z", "origin": origin } },
            "geometricError": error,
            "root": { "geometricError": error, "refine": "ADD", "children": children, "boundingVolume": volume },
        });
        Ok(tileset.to_string().into_bytes())
    }
}
