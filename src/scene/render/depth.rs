//! Triangles into a depth buffer.

/// Depths of a picture, larger is nearer; 0 where there is nothing.
pub(super) struct DepthBuffer {
    pub width: usize,
    pub height: usize,
    pub depths: Vec<f32>,
}

impl DepthBuffer {
    pub(super) fn new(width: usize, height: usize) -> Self {
        let depths = vec![0.0; width * height];
        Self {
            width,
            height,
            depths,
        }
    }

    /// Fills a triangle of pixel coordinates and depth, y down, and tells of each pixel that it is
    /// the nearest of so far. Depth is linear over the picture.
    pub(super) fn triangle(&mut self, corners: [[f32; 3]; 3], mut seen: impl FnMut(usize)) {
        let [a, b, c] = corners;
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        if !area.is_finite() || area.abs() < 1e-9 {
            return;
        }
        let low = |i: usize| a[i].min(b[i]).min(c[i]);
        let high = |i: usize| a[i].max(b[i]).max(c[i]);
        // Pixel centres lie at halves.
        let first = |v: f32| (v - 0.5).ceil().max(0.0) as usize;
        let last =
            |v: f32, count: usize| ((v - 0.5).floor() + 1.0).clamp(0.0, count as f32) as usize;
        let (left, right) = (first(low(0)), last(high(0), self.width));
        for row in first(low(1))..last(high(1), self.height) {
            let y = row as f32 + 0.5;
            for column in left..right {
                let x = column as f32 + 0.5;
                let u = ((b[0] - x) * (c[1] - y) - (c[0] - x) * (b[1] - y)) / area;
                let v = ((c[0] - x) * (a[1] - y) - (a[0] - x) * (c[1] - y)) / area;
                let w = 1.0 - u - v;
                if u < 0.0 || v < 0.0 || w < 0.0 {
                    continue;
                }
                let depth = u * a[2] + v * b[2] + w * c[2];
                let pixel = row * self.width + column;
                if depth > self.depths[pixel] {
                    self.depths[pixel] = depth;
                    seen(pixel);
                }
            }
        }
    }
}
