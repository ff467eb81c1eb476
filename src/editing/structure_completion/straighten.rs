//! Drawings that begin with a photograph: its four corners give the outline, one length its scale.

use std::path::Path;
use std::sync::Arc;

use serde_json::{Value, json};

use super::super::script::{Shell, Word};
use super::super::{Applied, written};
use super::{ENDING, Sketch};
use edifice_base::{Error, Result};
use edifice_io::photograph::{self, Picture, ReadPhotographError};
use edifice_shape::rectification::Corners;
use edifice_shape::{AnnotatedFacade, Facade, LayoutError};

/// Height of a facade in metres where nobody said another.
pub const USUAL_HEIGHT: f64 = 12.0;

/// The outline that a straightened photograph fills.
#[derive(Debug, Clone)]
pub enum Outline {
    /// Height in metres; the width follows from the corners.
    Height(f64),
    /// Width in metres; the height follows from the corners.
    Width(f64),
    /// That of a drawing, whose elements stay.
    Of(Box<AnnotatedFacade>),
}

/// Why a photograph is not straightened.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StraightenError {
    /// The picture or its corners.
    #[error(transparent)]
    Picture(#[from] photograph::StraightenError),
    /// The length.
    #[error(transparent)]
    Outline(#[from] LayoutError),
    /// There is no photograph to straighten.
    #[error("this drawing was not opened from a photograph: name the picture to straighten")]
    NoPicture,
    /// The outline of a drawing with elements.
    #[error("the drawing has elements, so its outline stays: straighten without a height")]
    Drawn,
}

impl From<ReadPhotographError> for StraightenError {
    fn from(error: ReadPhotographError) -> Self {
        Self::Picture(error.into())
    }
}

impl From<edifice_shape::rectification::CornersError> for StraightenError {
    fn from(error: edifice_shape::rectification::CornersError) -> Self {
        Self::Picture(error.into())
    }
}

/// A drawing over the rectangle that four corners of a photograph enclose, upper left, upper right, lower right, lower left, in pixels
/// from its upper left corner; without corners the whole picture is taken.
///
/// # Errors
/// [`StraightenError`].
pub fn straightened(
    name: &str,
    bytes: &[u8],
    corners: Option<[[f64; 2]; 4]>,
    outline: Outline,
) -> std::result::Result<AnnotatedFacade, StraightenError> {
    over(name, &Picture::of_bytes(bytes)?, corners, outline)
}

/// The same over a picture that was read.
fn over(
    name: &str,
    picture: &Picture,
    corners: Option<[[f64; 2]; 4]>,
    outline: Outline,
) -> std::result::Result<AnnotatedFacade, StraightenError> {
    let told = match outline {
        Outline::Height(h) => Some(("height", h)),
        Outline::Width(w) => Some(("width", w)),
        Outline::Of(_) => None,
    };
    if let Some((dimension, value)) = told.filter(|(_, v)| !(v.is_finite() && *v > 0.0)) {
        return Err(LayoutError::FacadeSize { dimension, value }.into());
    }
    let corners = match corners {
        Some(places) => Corners::new(places)?,
        None => Corners::whole(picture.size())?,
    };
    let aspect = corners.aspect(picture.size());
    let centimetres = |v: f64| (v * 100.0).round() / 100.0;
    let begin = |width, height| Facade::new(name, "m", width, height, Vec::new());
    let mut drawing = match outline {
        Outline::Height(h) => AnnotatedFacade::plain(begin(centimetres(h * aspect), h)?),
        Outline::Width(w) => AnnotatedFacade::plain(begin(w, centimetres(w / aspect))?),
        Outline::Of(drawing) => *drawing,
    };
    let proportion = drawing.facade.width / drawing.facade.height;
    drawing.photograph = Some(picture.straightened(&corners, proportion)?);
    Ok(drawing)
}

/// The photograph that a drawing was opened from, until its corners are known.
pub(super) struct Original {
    /// Its file, beside which the drawing is saved.
    file: String,
    bytes: Arc<[u8]>,
    size: [u32; 2],
}

impl Original {
    /// Its file and size, by which a page asks for its corners.
    pub(super) fn shown(&self) -> Value {
        json!({"file": self.file, "width": self.size[0], "height": self.size[1]})
    }

    /// Its address.
    pub(super) fn address(&self) -> String {
        photograph::address_of_bytes(&self.bytes)
    }
}

/// Opens a photograph: the whole picture, [`USUAL_HEIGHT`] high, until its corners are put.
pub(super) fn open(path: &Path, bytes: &[u8]) -> Result<Sketch> {
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    let outline = Outline::Height(USUAL_HEIGHT);
    let read = || {
        let picture = Picture::of_bytes(bytes)?;
        Ok((over(&name, &picture, None, outline)?, picture.size()))
    };
    let (drawing, size) = read().map_err(|e: StraightenError| Error::content(path, e))?;
    let original = Original {
        file: file.into_owned(),
        bytes: bytes.into(),
        size,
    };
    Ok(Sketch {
        original: Some(Arc::new(original)),
        ..Sketch::new(drawing)
    })
}

impl Sketch {
    /// Straightens a picture, or the one that the drawing was opened from; with a height the outline is new, without it stays.
    pub(super) fn straighten(
        &self,
        picture: Option<&str>,
        corners: [[f64; 2]; 4],
        height: Option<f64>,
    ) -> Result<Applied> {
        let (bytes, word) = match (picture, &self.original) {
            (Some(address), _) => {
                let bytes = photograph::bytes_of_address(address).map_err(Error::method)?;
                let word = Word::File(".photograph.txt", address.to_owned());
                (Arc::from(bytes), word)
            }
            (None, Some(original)) => (original.bytes.clone(), Word::Beside(original.file.clone())),
            (None, None) => return Err(Error::method(StraightenError::NoPicture)),
        };
        let name = self.layout.facade.name.clone();
        let mut shell = Shell::new(["facade", "straighten"]);
        shell.words.push(word);
        shell = shell.option("--corners", written(corners.as_flattened()));
        let outline = match height {
            Some(height) => {
                if !self.layout.facade.regions.is_empty() {
                    return Err(Error::method(StraightenError::Drawn));
                }
                shell = shell.option("--height", height).option("--name", &name);
                Outline::Height(height)
            }
            None => {
                shell.words.extend(Shell::new(["--into", "<"]).words);
                Outline::Of(Box::new(self.layout.clone()))
            }
        };
        shell.words.extend(Shell::new(["--output", ">"]).words);
        let made = straightened(&name, &bytes, Some(corners), outline).map_err(Error::method)?;
        let (width, height) = (made.facade.width, made.facade.height);
        let unit = made.facade.unit.clone();
        let state = Self {
            pins: self.pins.clone(),
            forbidden: self.forbidden.clone(),
            ..Self::new(made)
        };
        Ok(Applied {
            state: Arc::new(state),
            said: format!("photograph straightened to {width} x {height} {unit}"),
            shell: shell.gives(ENDING, Some(String::new())),
            warnings: Vec::new(),
        })
    }
}
