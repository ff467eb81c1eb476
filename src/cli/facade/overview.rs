//! An SVG sheet: the input and its completions side by side.

use std::fmt::Write;

use edifice_io::palette::Palette;
use edifice_shape::AnnotatedFacade;

/// Height of a panel.
const PANEL: f64 = 360.0;
/// Space between panels.
const MARGIN: f64 = 16.0;

/// Panels with their titles. Observed elements are solid, added ones as opaque as they are probable, unknown parts grey.
pub(super) fn svg(panels: &[(String, &AnnotatedFacade)]) -> String {
    let labels = panels
        .iter()
        .flat_map(|(_, p)| p.facade.regions.iter().map(|r| r.label.as_str()));
    let palette = Palette::new(labels);
    let mut body = String::new();
    let (mut x, mut height) = (MARGIN, 0.0f64);
    for (title, panel) in panels {
        let facade = &panel.facade;
        let scale = PANEL / facade.width.max(facade.height);
        let (wide, high) = (facade.width * scale, facade.height * scale);
        height = height.max(high);
        // Writing to a String cannot fail.
        let _ = writeln!(
            body,
            "<g transform=\"translate({x:.1} 40)\">\n<text y=\"-10\" font-family=\"sans-serif\" font-size=\"13\">{title}</text>\n\
             <rect width=\"{wide:.1}\" height=\"{high:.1}\" fill=\"#e9dfcd\"/>"
        );
        let rect = |r: &edifice_shape::Rect| {
            format!(
                "x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\"",
                r.x * scale,
                (facade.height - r.top()) * scale,
                r.width * scale,
                r.height * scale
            )
        };
        for unknown in panel.unknown.iter().flatten() {
            let _ = writeln!(
                body,
                "<rect {} fill=\"#9a9a9a\" fill-opacity=\"0.35\"/>",
                rect(unknown)
            );
        }
        for (region, note) in facade.regions.iter().zip(&panel.notes) {
            let [r, g, b] = palette.color(&region.label);
            let (opacity, dash) = match note.probability {
                Some(p) if note.observed == Some(false) => {
                    (0.25 + 0.65 * p, " stroke-dasharray=\"3 2\"")
                }
                _ => (1.0, ""),
            };
            let _ = writeln!(
                body,
                "<rect {} fill=\"#{r:02x}{g:02x}{b:02x}\" fill-opacity=\"{opacity:.2}\" stroke=\"#222222\" stroke-width=\"0.8\"{dash}/>",
                rect(&region.rect)
            );
        }
        body.push_str("</g>\n");
        x += wide.max(90.0) + MARGIN;
    }
    let height = height + 40.0 + MARGIN;
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{x:.0}\" height=\"{height:.0}\" viewBox=\"0 0 {x:.0} {height:.0}\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{body}</svg>\n"
    )
}
