//! The table of all knobs. The command line takes its help from it, and the sweep its values.

/// Where a sweep goes along a knob.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Range {
    /// From coarse and cheap to fine.
    pub values: &'static [&'static str],
    /// Where it begins.
    pub begin: &'static str,
    /// Where bias is least. Of samples, which cost time and remove noise alone, no more than it takes to tell noise from bias.
    pub finest: &'static str,
}

/// Something to choose that trades accuracy for time or memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Knob {
    /// `slhb`, `voxel`, or `all` for every method.
    pub method: &'static str,
    /// On the command line.
    pub flag: &'static str,
    /// What it is, in a line.
    pub help: &'static str,
    /// Of its values; empty where they are names.
    pub unit: &'static str,
    /// What it may be.
    pub range: &'static str,
    /// What it is where nothing is said.
    pub default: &'static str,
    /// What more or less of it gives and takes.
    pub trades: &'static str,
    /// The kernel whose cost it sets most; empty where that depends on the method.
    pub kernel: &'static str,
    /// How the sweep varies it, if it does.
    pub sweep: Option<Range>,
}

const fn range(values: &'static [&'static str], begin: &'static str, finest: &'static str) -> Option<Range> {
    Some(Range { values, begin, finest })
}

/// Every knob, those of all methods first.
pub const KNOBS: &[Knob] = &[
    Knob {
        method: "all",
        flag: "--spp",
        help: "Samples per pixel [default: the scene's, else 64; unlimited with --time]",
        unit: "samples per pixel",
        range: "1 to 16777216",
        default: "64",
        trades: "noise against time: four times the samples halve the noise of independent samples. Bias stays",
        kernel: "",
        sweep: range(&["1", "4", "16", "64", "256"], "16", "64"),
    },
    Knob {
        method: "all",
        flag: "--bounces",
        help: "Times light may scatter: 0 shows emitters alone, 1 direct light, `unlimited` everything [default: the scene's, else unlimited]; --method voxel gathers up to 64 times, and 3 times for `unlimited`",
        unit: "bounces",
        range: "0 to 4294967294, or unlimited",
        default: "unlimited",
        trades: "light that was scattered often, which makes white rooms bright, against time",
        kernel: "",
        sweep: None,
    },
    Knob {
        method: "all",
        flag: "--sampler",
        help: "Where random numbers come from",
        unit: "",
        range: "sobol, independent",
        default: "sobol",
        trades: "Sobol points have less noise for the same time; independent numbers have a variance that can be tested",
        kernel: "",
        sweep: None,
    },
    Knob {
        method: "all",
        flag: "--tolerance",
        help: "Most that a pixel may lack because of what --effects auto leaves out, as a share of the exposure's white [default: 1/255; 0 for --method reference, which leaves out only what isn't there]",
        unit: "of white",
        range: "0 or more",
        default: "1/255",
        trades: "light too faint to be seen against the bounces and effects that it takes",
        kernel: "",
        sweep: None,
    },
    Knob {
        method: "all",
        flag: "--mode",
        help: "Float arithmetic of a GPU: strict gives the CPU's bits [default: strict where the adapter can]",
        unit: "",
        range: "strict, portable",
        default: "strict",
        trades: "the same bits everywhere against what a driver gains by fusing and reordering",
        kernel: "",
        sweep: None,
    },
    Knob {
        method: "slhb",
        flag: "--directions",
        help: "Directions that hit buffers are built for: a number, or icosahedron:N, octahedron:N, halton:N, uv:ROWSxCOLUMNS",
        unit: "directions",
        range: "20, 80, 320, 1280 or other",
        default: "320",
        trades: "bands and blurred reflections of few directions against memory and time to build, which grow as their number",
        kernel: "rasterize_lhb",
        sweep: range(&["20", "80", "320", "1280"], "320", "1280"),
    },
    Knob {
        method: "slhb",
        flag: "--lhb-size",
        help: "Pixels per row and column of a hit buffer, 1 to 1024",
        unit: "pixels",
        range: "1 to 1024",
        default: "128",
        trades: "leaks at edges and small things that are missed against memory and time, which grow as its square",
        kernel: "rasterize_lhb",
        sweep: range(&["32", "64", "128", "256"], "128", "256"),
    },
    Knob {
        method: "slhb",
        flag: "--layers",
        help: "Surfaces that a pixel of a hit buffer keeps: all, or the nearest N",
        unit: "layers",
        range: "1 or more, or all",
        default: "all",
        trades: "light from surfaces behind others, which few layers lose, against memory",
        kernel: "rasterize_lhb",
        sweep: range(&["1", "2", "4", "all"], "all", "all"),
    },
    Knob {
        method: "slhb",
        flag: "--elements",
        help: "How their elements are stored: full, packed (half the bytes each, depths to 1/4096 of the scene), or layers:K (packed, the nearest K)",
        unit: "",
        range: "full, packed, layers:K",
        default: "full",
        trades: "half the memory against time to pack and to read back, and against depths that are rounded",
        kernel: "pack_lhb",
        sweep: range(&["layers:4", "packed", "full"], "full", "full"),
    },
    Knob {
        method: "slhb",
        flag: "--cone",
        help: "Whether lookups follow the ray or its nearest direction alone",
        unit: "",
        range: "auto, off",
        default: "auto",
        trades: "bands of light where directions are few against a second lookup per ray",
        kernel: "walk_lhb",
        sweep: range(&["off", "auto"], "auto", "auto"),
    },
    Knob {
        method: "slhb",
        flag: "--misses",
        help: "What becomes of rays that lookups find nothing for",
        unit: "",
        range: "trace, leave",
        default: "trace",
        trades: "light lost beside silhouettes against the time to trace what was missed",
        kernel: "walk_lhb",
        sweep: range(&["leave", "trace"], "trace", "trace"),
    },
    Knob {
        method: "slhb",
        flag: "--shadows",
        help: "Which shadow rays are looked up instead of traced",
        unit: "",
        range: "rays, indirect, all",
        default: "rays",
        trades: "shadows as sharp as geometry against time: lookups are cheaper than rays in scenes of many triangles, and have the resolution of the hit buffers",
        kernel: "walk_lhb",
        sweep: range(&["all", "indirect", "rays"], "rays", "rays"),
    },
    Knob {
        method: "slhb",
        flag: "--gather",
        help: "Whether the first vertex of each path gathers light along all directions",
        unit: "",
        range: "off, all",
        default: "off",
        trades: "noise of the first vertex, of which nothing is left, against a sample per direction",
        kernel: "walk_lhb",
        sweep: range(&["all", "off"], "off", "off"),
    },
    Knob {
        method: "slhb",
        flag: "--interleave",
        help: "Let diffuse surfaces scatter by the same random numbers in every tile of N x N pixels, 1 to 32, so that --filter N finds all of them; 1 is off",
        unit: "pixels",
        range: "1 to 32",
        default: "1",
        trades: "noise, which --filter N then removes best, against a pattern where nothing is filtered",
        kernel: "walk_lhb",
        sweep: range(&["8", "4", "1"], "1", "1"),
    },
    Knob {
        method: "slhb",
        flag: "--filter",
        help: "Average indirect light over N x N pixels that show the same diffuse surface, 1 to 32; 1 is off",
        unit: "pixels",
        range: "1 to 32",
        default: "1",
        trades: "noise, which falls to about an Nth where so many are averaged, against contact shadows of indirect light, which are blurred over N pixels. Mirrors, glass, glossy surfaces and direct light stay as they are",
        kernel: "filter_indirect",
        sweep: range(&["8", "4", "1"], "1", "1"),
    },
    Knob {
        method: "voxel",
        flag: "--grid",
        help: "Voxels along the scene's longest side, 1 to 512",
        unit: "voxels",
        range: "1 to 512",
        default: "128",
        trades: "leaks and blur against memory and time, which grow as its square",
        kernel: "voxelize",
        sweep: range(&["32", "64", "128", "256"], "128", "256"),
    },
    Knob {
        method: "voxel",
        flag: "--storage",
        help: "What voxels store of the light that leaves them: iso (a colour), aniso (one per face), sh (spherical harmonics) or sh8 (those in bytes)",
        unit: "",
        range: "iso, sh8, aniso, sh",
        default: "aniso",
        trades: "light that shows through thin walls against memory",
        kernel: "reduce_mips",
        sweep: range(&["iso", "sh8", "aniso", "sh"], "aniso", "sh"),
    },
    Knob {
        method: "voxel",
        flag: "--cones",
        help: "Cones that gather diffuse light: 6 (of 60 degrees, a sample per level), or generic:N (4 to 256 narrower ones, slower and smoother; generic is generic:16)",
        unit: "cones",
        range: "6, or generic:4 to generic:256",
        default: "6",
        trades: "light that is blurred over wide angles against time, which grows as their number",
        kernel: "trace_cones",
        sweep: range(&["6", "generic:8", "generic:32"], "6", "generic:32"),
    },
    Knob {
        method: "voxel",
        flag: "--light-samples",
        help: "Shadow rays per voxel",
        unit: "rays",
        range: "1 to 1024",
        default: "8",
        trades: "blotches of light that few rays leave on voxels against time",
        kernel: "light_voxels",
        sweep: range(&["1", "8", "32"], "8", "8"),
    },
];

/// The knob of a flag.
pub fn find(flag: &str) -> Option<&'static Knob> {
    KNOBS.iter().find(|knob| knob.flag == flag)
}

/// What a flag is, in a line; empty for a flag that is no knob.
pub fn help(flag: &str) -> &'static str {
    find(flag).map_or("", |knob| knob.help)
}

/// What a flag is and what it trades.
pub fn long_help(flag: &str) -> String {
    find(flag).map_or_else(String::new, |knob| format!("{}\n\nTrades {}.", knob.help, knob.trades))
}

/// The table as Markdown: what `KNOBS.md` holds.
pub fn markdown() -> String {
    let row = |knob: &Knob| {
        let Knob { method, flag, unit, range, default, trades, .. } = knob;
        format!("| `{flag}` | {method} | {range} | {unit} | {default} | {trades} |\n")
    };
    let head = "| flag | method | range | unit | default | trades |\n|---|---|---|---|---|---|\n";
    head.to_owned() + &KNOBS.iter().map(row).collect::<String>()
}

/// The knobs that a method is swept along, with how.
pub fn swept(method: &str) -> impl Iterator<Item = (&'static Knob, Range)> {
    let knobs = KNOBS.iter().filter(move |knob| knob.method == method || knob.method == "all");
    knobs.filter_map(|knob| knob.sweep.map(|range| (knob, range)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slhb::LookupSettings;
    use crate::voxel::VoxelSettings;

    #[test]
    fn sweeps_hold_where_they_begin_and_end() {
        for knob in KNOBS {
            let twins = KNOBS.iter().filter(|other| other.flag == knob.flag).count();
            assert_eq!(twins, 1, "{}", knob.flag);
            assert!(!knob.help.is_empty() && !knob.trades.is_empty() && !knob.range.is_empty());
            let Some(range) = knob.sweep else { continue };
            let place = |value| range.values.iter().position(|other| *other == value);
            assert!(place(range.begin).is_some(), "{}", knob.flag);
            let last = place(range.finest).unwrap() + 1 == range.values.len();
            assert!(last || ["--spp", "--light-samples"].contains(&knob.flag), "{}", knob.flag);
            assert!(knob.method == "all" || range.begin == knob.default, "{}", knob.flag);
        }
    }

    /// The table's defaults are those of the library.
    #[test]
    fn defaults_are_the_methods_own() {
        let default = |flag| find(flag).unwrap().default;
        let (lookups, voxels) = (LookupSettings::default(), VoxelSettings::default());
        assert_eq!(default("--directions"), lookups.directions.len().to_string());
        assert_eq!(default("--lhb-size"), lookups.size.to_string());
        assert_eq!(default("--elements"), lookups.elements.to_string());
        assert_eq!(default("--interleave"), lookups.interleave.to_string());
        assert_eq!((default("--cone"), default("--layers")), ("auto", "all"));
        assert!(lookups.cone && lookups.layers.is_none() && lookups.trace_misses && !lookups.gather);
        assert_eq!(default("--grid"), voxels.grid.to_string());
        assert_eq!(default("--storage"), voxels.storage.to_string());
        assert_eq!(default("--cones"), voxels.cones.to_string());
        assert_eq!(default("--light-samples"), voxels.light_samples.to_string());
    }

    #[test]
    fn the_documentation_holds_the_table() {
        let page = include_str!("../../../KNOBS.md");
        assert!(page.ends_with(&markdown()), "KNOBS.md must end in\n{}", markdown());
    }

    #[test]
    fn help_says_what_is_traded() {
        assert_eq!(help("--grid"), "Voxels along the scene's longest side, 1 to 512");
        assert!(
            long_help("--grid")
                .ends_with("Trades leaks and blur against memory and time, which grow as its square.")
        );
        assert_eq!((help("--nothing"), long_help("--nothing").as_str()), ("", ""));
    }
}
