//! Values of flags, parsed with messages that show the form.

use std::fmt;
use std::str::FromStr;
use twinlight::scene::Camera;

/// Most pixels along a side.
const MAX_SIDE: u32 = 16384;

/// `WxH`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size(pub u32, pub u32);

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let side = |s: &str| s.parse().ok().filter(|n| (1..=MAX_SIDE).contains(n));
        text.split_once(['x', 'X', '×'])
            .and_then(|(w, h)| Some(Self(side(w)?, side(h)?)))
            .ok_or_else(|| format!("write WIDTHxHEIGHT, such as 640x480, each from 1 to {MAX_SIDE}"))
    }
}

/// `px,py,pz tx,ty,tz [ux,uy,uz] vfov`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraArg(pub Camera);

impl FromStr for CameraArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let camera = match words[..] {
            [position, target, vfov] => read_camera(position, target, "0,1,0", vfov),
            [position, target, up, vfov] => read_camera(position, target, up, vfov),
            _ => None,
        };
        let Some(camera) = camera else {
            let form = "\"px,py,pz tx,ty,tz [ux,uy,uz] vfov\", such as \"0,1,3 0,1,0 40\"";
            return Err(format!("write position, target, up (if not +Y) and vertical field of view: {form}"));
        };
        // An eye in its own target and the like: found here, where the flag can be named.
        camera.record(1, 1, [0.0; 3]).map_err(|e| e.to_string())?;
        Ok(Self(camera))
    }
}

impl fmt::Display for CameraArg {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |[x, y, z]: [f64; 3]| format!("{x},{y},{z}");
        let Camera { position, target, up, vfov_degrees } = self.0;
        write!(f, "{} {} {} {vfov_degrees}", list(position), list(target), list(up))
    }
}

fn read_camera(position: &str, target: &str, up: &str, vfov: &str) -> Option<Camera> {
    let vfov_degrees = vfov.parse().ok()?;
    Some(Camera { position: vector(position)?, target: vector(target)?, up: vector(up)?, vfov_degrees })
}

fn vector(text: &str) -> Option<[f64; 3]> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|n| n.parse().ok()).collect();
    numbers?.try_into().ok()
}

/// A number of bytes with an optional unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bytes(pub u64);

impl FromStr for Bytes {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let digits = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
        let (number, unit) = text.split_at(digits);
        let shift = match unit.trim().to_ascii_lowercase().as_str() {
            "" | "b" => 0,
            "k" | "kib" => 10,
            "m" | "mib" => 20,
            "g" | "gib" => 30,
            "t" | "tib" => 40,
            _ => return Err("write a number and B, KiB, MiB, GiB or TiB, such as 4GiB".into()),
        };
        let bytes = number.parse::<u64>().ok().and_then(|n| n.checked_mul(1 << shift));
        bytes.map(Self).ok_or_else(|| "write a whole number of bytes, such as 4GiB".into())
    }
}

/// Scattering vertices of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bounces(pub Option<u32>);

impl FromStr for Bounces {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.parse() {
            Ok(u32::MAX) => Err(format!("at most {}, or `unlimited`", u32::MAX - 1)),
            Ok(n) => Ok(Self(Some(n))),
            Err(_) if text == "unlimited" => Ok(Self(None)),
            Err(_) => Err("write a number, or `unlimited`".into()),
        }
    }
}

/// Positive seconds, such as `10`, `10s` or `2.5`.
pub fn seconds(text: &str) -> Result<f64, String> {
    let number = text.strip_suffix('s').unwrap_or(text).parse::<f64>();
    // A year: beyond it the number is more likely a mistake than a wish.
    number
        .ok()
        .filter(|s| *s > 0.0 && *s <= 31_536_000.0)
        .ok_or_else(|| "write seconds above 0, such as 10 or 2.5".into())
}

/// A mean ꟻLIP, such as 0.05.
pub fn flip(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|flip| *flip > 0.0 && *flip < 1.0);
    number.ok_or_else(|| "write a number between 0 and 1, such as 0.05".into())
}

/// Seconds of a motion, such as `0`, `1.5` or `2s`.
pub fn moment(text: &str) -> Result<f64, String> {
    let number = text.strip_suffix('s').unwrap_or(text).parse::<f64>();
    let moment = number.ok().filter(|s| (0.0..=31_536_000.0).contains(s));
    moment.ok_or_else(|| "write seconds from 0 on, such as 1 or 2.5".into())
}

/// Frames per second.
pub fn frame_rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok().filter(|rate| (0.001..=100_000.0).contains(rate));
    rate.ok_or_else(|| "write frames per second above 0, such as 24 or 29.97".into())
}

/// Most frames of a sequence.
const MAX_FRAMES: u32 = 1_000_000;

/// `FIRST..END`, or `FIRST..` up to the end of the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FrameRange {
    /// The first frame.
    pub first: u32,
    /// The first that is not rendered any more.
    pub end: Option<u32>,
}

impl FromStr for FrameRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.parse().ok().filter(|&n: &u32| n <= MAX_FRAMES);
        let range = text.split_once("..").and_then(|(first, end)| {
            let end = if end.is_empty() { None } else { Some(number(end)?) };
            let range = Self { first: number(first)?, end };
            range.end.is_none_or(|end| range.first < end).then_some(range)
        });
        let form = "such as 0..48 for the 48 frames 0 to 47, or 0.. for all";
        range.ok_or_else(|| format!("write FIRST..END, {form}; numbers up to {MAX_FRAMES}"))
    }
}

/// Which backend runs the kernels.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum BackendChoice {
    /// A hardware GPU if there is one, else the CPU.
    #[default]
    Auto,
    /// The CPU.
    Cpu,
    /// A GPU adapter: empty for the best, a number, or part of a name.
    Gpu(String),
}

impl FromStr for BackendChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once(':') {
            None if text == "auto" => Ok(Self::Auto),
            None if text == "cpu" => Ok(Self::Cpu),
            None if text == "gpu" => Ok(Self::Gpu(String::new())),
            Some(("gpu", selector)) if !selector.is_empty() => Ok(Self::Gpu(selector.to_owned())),
            _ => Err("write auto, cpu, gpu, or gpu:SELECTOR with a number or part of a name from \
                      `twinlight devices`"
                .into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!("640x480".parse(), Ok(Size(640, 480)));
        for bad in ["", "640", "0x1", "16385x1", "-1x1", "1x1x1", "axb"] {
            assert!(bad.parse::<Size>().is_err(), "{bad}");
        }
    }

    #[test]
    fn cameras() {
        let CameraArg(camera) = "0,1,3  0,1,0 40".parse().unwrap();
        assert_eq!(
            (camera.position, camera.up, camera.vfov_degrees),
            ([0.0, 1.0, 3.0], [0.0, 1.0, 0.0], 40.0)
        );
        let CameraArg(camera) = "0,1,3 0,1,0 1,1,0 35.5".parse().unwrap();
        assert_eq!(CameraArg(camera).to_string(), "0,1,3 0,1,0 1,1,0 35.5");
        assert_eq!((camera.up, camera.vfov_degrees), ([1.0, 1.0, 0.0], 35.5));
        for bad in
            ["", "0,1 0,1,0 40", "0,1,3 0,1,0", "0,1,3 0,1,3 40", "0,0,3 0,0,0 180", "nan,0,0 0,0,1 40"]
        {
            assert!(bad.parse::<CameraArg>().is_err(), "{bad}");
        }
    }

    #[test]
    fn byte_counts() {
        assert_eq!("4GiB".parse(), Ok(Bytes(4 << 30)));
        assert_eq!("512 m".parse(), Ok(Bytes(512 << 20)));
        assert_eq!("7".parse(), Ok(Bytes(7)));
        for bad in ["", "GiB", "1.5G", "4GB", "99999999999T"] {
            assert!(bad.parse::<Bytes>().is_err(), "{bad}");
        }
    }

    #[test]
    fn bounce_counts_and_times() {
        assert_eq!("0".parse(), Ok(Bounces(Some(0))));
        assert_eq!("unlimited".parse(), Ok(Bounces(None)));
        assert!("4294967295".parse::<Bounces>().is_err() && "-1".parse::<Bounces>().is_err());
        assert_eq!((seconds("2.5"), seconds("10s")), (Ok(2.5), Ok(10.0)));
        for bad in ["0", "-1", "nan", "inf", "s", "1e9"] {
            assert!(seconds(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn frame_ranges_and_moments() {
        assert_eq!("0..48".parse(), Ok(FrameRange { first: 0, end: Some(48) }));
        assert_eq!("7..".parse(), Ok(FrameRange { first: 7, end: None }));
        for bad in ["", "..", "..5", "5", "5..5", "6..5", "0..=5", "0..1000001", "-1..2", "0...5"] {
            assert!(bad.parse::<FrameRange>().is_err(), "{bad}");
        }
        assert_eq!((moment("0"), moment("1.5s"), frame_rate("29.97")), (Ok(0.0), Ok(1.5), Ok(29.97)));
        assert!(moment("-1").is_err() && moment("nan").is_err() && frame_rate("0").is_err());
    }

    #[test]
    fn backends() {
        assert_eq!("gpu:llvmpipe".parse(), Ok(BackendChoice::Gpu("llvmpipe".into())));
        assert_eq!("gpu".parse(), Ok(BackendChoice::Gpu(String::new())));
        assert!("gpu:".parse::<BackendChoice>().is_err() && "cuda".parse::<BackendChoice>().is_err());
    }
}
