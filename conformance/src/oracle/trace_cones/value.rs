//! What leaves a voxel against a cone.

use super::Within;
use twinlight_core::kernels::reduce_mips::{ANISOTROPIC, HARMONICS, ISOTROPIC, OPAQUE};

/// rgb and opacity, the latter in [`OPAQUE`]ths.
pub type Sample = [Within; 4];

const ZERO: Within = Within::exactly(0.0);
const ONE: Within = Within::exactly(1.0);

/// What `words` of a voxel of `level` show a cone along `direction`; the storage says what they mean.
pub fn seen(words: &[u32], storage: u32, level: u32, direction: [f64; 3]) -> Sample {
    match storage {
        ISOTROPIC => layered([0, 1, 2, 3].map(|w| unsigned(words[w])), level),
        ANISOTROPIC => from_faces(words, direction),
        HARMONICS => {
            let lobe = |c: usize| {
                [1, 2, 3, 4].map(|w| Within::exactly(f64::from(words[4 * c + w] as i32)).rounded())
            };
            layered(from_lobes([0, 1, 2].map(lobe), words[0], direction), level)
        }
        _ => {
            let step = f64::from(words[0] >> 24).exp2();
            let lobe = |c: usize| {
                let bytes = words[c + 1].to_le_bytes();
                let signed = [1, 2, 3].map(|w: usize| f64::from(bytes[w] as i8));
                [f64::from(bytes[0]), signed[0], signed[1], signed[2]].map(|q| Within::exactly(q * step))
            };
            layered(from_lobes([0, 1, 2].map(lobe), words[0] % (1 << 24), direction), level)
        }
    }
}

fn unsigned(word: u32) -> Within {
    Within::exactly(f64::from(word)).rounded()
}

/// The faces by which a cone comes in, weighed by the squares of its direction.
fn from_faces(words: &[u32], direction: [f64; 3]) -> Sample {
    let mut sum = [ZERO; 4];
    for (axis, component) in direction.into_iter().enumerate() {
        let face = 2 * axis + usize::from(component >= 0.0);
        let along = Within::exactly(component);
        for (w, sum) in sum.iter_mut().enumerate() {
            *sum = *sum + along * along * unsigned(words[4 * face + w]);
        }
    }
    sum
}

/// a₀ − a·ω per channel, and the opacity as it is.
fn from_lobes(lobes: [[Within; 4]; 3], opacity: u32, direction: [f64; 3]) -> Sample {
    let [x, y, z] = direction.map(Within::exactly);
    let [r, g, b] = lobes.map(|[a, ax, ay, az]| (a - (ax * x + ay * y + az * z)).max(ZERO));
    [r, g, b, unsigned(opacity)]
}

/// A mean over a voxel's space as that of the 2ˡ layers behind each other that it has room for.
fn layered(value: Sample, level: u32) -> Sample {
    let opacity = value[3].scaled(1.0 / f64::from(OPAQUE));
    if opacity.high <= 0.0 || value[3] == unsigned(0) {
        return value;
    }
    let mut through = if opacity.low >= 1.0 { ZERO } else { (ONE - opacity).max(ZERO) };
    for _ in 0..level {
        through = through * through;
    }
    let factor = (ONE - through).over(opacity);
    value.map(|v| v * factor)
}
