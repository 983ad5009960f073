//! Sets by name, as a command line gives them.

use super::{DirectionSet, MAX_DIRECTIONS};
use crate::error::{Error, Result};
use std::str::FromStr;

/// Sizes of subdivided polyhedra of `faces` faces.
fn sizes(faces: u32) -> impl Iterator<Item = u32> {
    std::iter::successors(Some(faces), |n| n.checked_mul(4)).take_while(|&n| n <= MAX_DIRECTIONS)
}

fn subdivisions(faces: u32, count: u32) -> Option<u32> {
    sizes(faces).position(|n| n == count).map(|k| k as u32)
}

fn refused(text: &str) -> Error {
    let list = |faces| sizes(faces).map(|n| n.to_string()).collect::<Vec<_>>().join(", ");
    let what = format!(
        "`{text}` is none of icosahedron:N (N = {}), octahedron:N ({}), halton:N (1 to {MAX_DIRECTIONS}), \
         uv:ROWSxCOLUMNS (even COLUMNS, at most {MAX_DIRECTIONS} in all), N",
        list(20),
        list(8),
    );
    Error::invalid("directions", what)
}

/// `icosahedron:320`, `octahedron:128`, `halton:50`, `uv:8x16`, or a number alone: an icosahedron's if it has that
/// many, else an octahedron's if it has, else Halton points.
impl FromStr for DirectionSet {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let number = |digits: &str| digits.parse::<u32>().map_err(|_| refused(text));
        let Some((shape, size)) = text.split_once(':') else {
            let count = number(text)?;
            return match (subdivisions(20, count), subdivisions(8, count)) {
                (Some(k), _) => Self::icosahedron(k),
                (None, Some(k)) => Self::octahedron(k),
                (None, None) => Self::halton(count),
            };
        };
        let level = |faces| number(size).and_then(|n| subdivisions(faces, n).ok_or_else(|| refused(text)));
        match shape {
            "icosahedron" => Self::icosahedron(level(20)?),
            "octahedron" => Self::octahedron(level(8)?),
            "halton" => Self::halton(number(size)?),
            "uv" => {
                let (rows, columns) = size.split_once('x').ok_or_else(|| refused(text))?;
                Self::uv_grid(number(rows)?, number(columns)?)
            }
            _ => Err(refused(text)),
        }
    }
}
