//! MTL: material libraries of OBJ files. What the keys mean here is in [`super::material`].

use crate::io::LoadOptions;
use crate::io::text::{self, Line, Token};
use std::collections::BTreeSet;
use twinlight_core::Result;

/// Keys of MTL and its physically based extension that have no effect here.
const WITHOUT_EFFECT: [&str; 32] = [
    "Ka",
    "Tf",
    "Tn",
    "Km",
    "Kt",
    "sharpness",
    "Pc",
    "Pcr",
    "Ps",
    "aniso",
    "anisor",
    "map_Ka",
    "map_Ks",
    "map_Ke",
    "map_Ns",
    "map_d",
    "map_Tr",
    "map_Pr",
    "map_Pm",
    "map_Ps",
    "map_RMA",
    "map_ORM",
    "map_bump",
    "map_Bump",
    "bump",
    "norm",
    "disp",
    "decal",
    "refl",
    "map_aat",
    "map_opacity",
    "map_refl",
];

const USED: [&str; 12] = ["newmtl", "Kd", "Ks", "Ke", "Ns", "Ni", "d", "Tr", "illum", "map_Kd", "Pr", "Pm"];

/// One `newmtl` block; of a key that is there twice, the last.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct MtlMaterial {
    pub name: String,
    /// `file:line:column` of the name.
    pub place: String,
    pub kd: Option<[f32; 3]>,
    pub ks: Option<[f32; 3]>,
    pub ke: Option<[f32; 3]>,
    pub ns: Option<f32>,
    pub ni: Option<f32>,
    pub d: Option<f32>,
    pub tr: Option<f32>,
    pub illum: Option<f32>,
    pub pr: Option<f32>,
    pub pm: Option<f32>,
    /// File name and where it stands.
    pub map_kd: Option<(String, String)>,
}

/// The materials of a library in order, and notices about what was not used.
///
/// # Errors
/// `InvalidInput` with file, line, column and value.
pub(super) fn parse(
    bytes: &[u8],
    name: &str,
    options: &LoadOptions,
    notices: &mut Vec<String>,
) -> Result<Vec<MtlMaterial>> {
    let mut materials: Vec<MtlMaterial> = Vec::new();
    let mut unused = BTreeSet::new();
    for line in text::lines(bytes) {
        let mut tokens = line.tokens();
        let Some(key) = tokens.next() else { continue };
        let Ok(word) = std::str::from_utf8(key.bytes) else {
            return Err(key.error(name, format!("key '{}' is not UTF-8: is this an MTL file?", key.shown())));
        };
        if word == "newmtl" {
            let Some(first) = tokens.next() else { return Err(key.error(name, "newmtl without a name")) };
            let label = line.rest_from(first);
            materials.push(MtlMaterial {
                name: String::from_utf8_lossy(label.bytes).into_owned(),
                place: label.place(name),
                ..MtlMaterial::default()
            });
        } else if USED.contains(&word) {
            let Some(material) = materials.last_mut() else {
                return Err(key.error(name, format!("'{word}' before the first newmtl")));
            };
            read_key(material, word, line, key, tokens, name)?;
        } else if WITHOUT_EFFECT.contains(&word) {
            unused.insert(word.to_owned());
        } else {
            let is_new = unused.insert(key.shown());
            if !is_new || (notices.len() >= super::MAX_NOTICES && !options.strict) {
                continue;
            }
            let hint = text::did_you_mean(word, USED.into_iter().chain(WITHOUT_EFFECT));
            let what = format!("unknown key '{}'{hint}", key.shown());
            if options.strict {
                return Err(key.error(name, what));
            }
            notices.push(format!("{}: {what} ignored", key.place(name)));
        }
    }
    let without_effect: Vec<&str> =
        unused.iter().map(String::as_str).filter(|k| WITHOUT_EFFECT.contains(k) && *k != "Ka").collect();
    if !without_effect.is_empty() {
        notices.push(format!("{name}: keys without effect here: {}", without_effect.join(", ")));
    }
    Ok(materials)
}

fn read_key<'a>(
    material: &mut MtlMaterial,
    word: &str,
    line: Line<'a>,
    key: Token<'a>,
    mut values: impl Iterator<Item = Token<'a>>,
    name: &str,
) -> Result<()> {
    if word == "map_Kd" {
        material.map_kd = Some(texture_name(line, key, values, name)?);
        return Ok(());
    }
    let mut next = |what: &str| match values.next() {
        Some(token) => Ok((text::number(token, what, name, false)?, token)),
        None => Err(key.error(name, format!("{word} needs a number: its {what} is missing"))),
    };
    let range = |(value, token): (f32, Token<'_>), low: f32, high: f32| {
        if value >= low && value <= high {
            return Ok(value);
        }
        let bound =
            if high < f32::MAX { format!("within {low} and {high}") } else { format!("at least {low}") };
        Err(token.error(name, format!("{word} {} is not {bound}", token.shown())))
    };
    match word {
        "Kd" | "Ks" | "Ke" => {
            let red = range(next("red")?, 0.0, f32::MAX)?;
            // One number stands for all three, as the format's definition has it.
            let color = match next("green") {
                Ok(green) => [red, range(green, 0.0, f32::MAX)?, range(next("blue")?, 0.0, f32::MAX)?],
                Err(e) if green_is_there(line) => return Err(e),
                Err(_) => [red; 3],
            };
            match word {
                "Kd" => material.kd = Some(color),
                "Ks" => material.ks = Some(color),
                _ => material.ke = Some(color),
            }
        }
        "Ns" => material.ns = Some(range(next("value")?, 0.0, f32::MAX)?),
        "Ni" => material.ni = Some(range(next("value")?, 0.0, f32::MAX)?),
        "Tr" => material.tr = Some(range(next("value")?, 0.0, 1.0)?),
        "illum" => material.illum = Some(range(next("value")?, 0.0, 10.0)?),
        "Pr" => material.pr = Some(range(next("value")?, 0.0, 1.0)?),
        "Pm" => material.pm = Some(range(next("value")?, 0.0, 1.0)?),
        // `d -halo 0.5` fades towards the silhouette; the factor is read as plain.
        _ if line.tokens().nth(1).is_some_and(|t| t.bytes == b"-halo") => {
            material.d = line.tokens().nth(2).map(|t| text::number(t, "value", name, false)).transpose()?;
        }
        _ => material.d = Some(range(next("value")?, 0.0, 1.0)?),
    }
    Ok(())
}

fn green_is_there(line: Line<'_>) -> bool {
    line.tokens().nth(2).is_some()
}

/// The file name after the options of a texture statement (`-s 1 1 1 -bm 0.5 name with blanks.png`).
fn texture_name<'a>(
    line: Line<'a>,
    key: Token<'a>,
    values: impl Iterator<Item = Token<'a>>,
    name: &str,
) -> Result<(String, String)> {
    let mut values = values.peekable();
    while let Some(option) = values.next_if(|t| t.bytes.first() == Some(&b'-') && t.bytes.len() > 1) {
        let arguments = match option.bytes {
            b"-o" | b"-s" | b"-t" => 3,
            b"-mm" => 2,
            b"-blendu" | b"-blendv" | b"-boost" | b"-texres" | b"-clamp" | b"-bm" | b"-imfchan"
            | b"-type" | b"-cc" | b"-colorspace" => 1,
            _ => return Err(option.error(name, format!("unknown texture option '{}'", option.shown()))),
        };
        for i in 0..arguments {
            // -o, -s and -t may leave out their second and third numbers.
            let optional = i > 0 && arguments == 3;
            let is_number =
                |t: &Token<'_>| std::str::from_utf8(t.bytes).is_ok_and(|t| t.parse::<f32>().is_ok());
            if optional {
                values.next_if(is_number)
            } else {
                values.next()
            };
        }
    }
    match values.next() {
        Some(first) => {
            let file = line.rest_from(first);
            let label = std::str::from_utf8(file.bytes)
                .map_err(|_| file.error(name, format!("file name '{}' is not UTF-8", file.shown())))?;
            Ok((label.to_owned(), file.place(name)))
        }
        None => Err(key.error(name, "map_Kd without a file name")),
    }
}
