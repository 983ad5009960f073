//! The planted bugs. A suite that never fails proves nothing: [`uncaught`] runs it on a backend with each of these, and
//! one that nobody notices is a hole.

use crate::expectations::{Verdict, judge};
use crate::faulty::Faulty;
use crate::suite;
use crate::trial::{Effort, Options, Trial};
use std::time::Instant;
use twinlight_core::{Backend, BackendInfo};

macro_rules! faults {
    ($($kernel:literal: $($variant:ident $story:literal),+;)+) => {
        /// One planted bug.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Fault {
            /// No bug: what the wrapper itself must not break.
            None,
            $($(#[doc = $story] $variant,)+)+
        }

        /// Every bug with the kernel it sits in and what it does.
        pub const FAULTS: &[(Fault, &str, &str)] = &[$($((Fault::$variant, $kernel, $story),)+)+];
    };
}

faults! {
    "scan":
        ScanInclusive "offsets include their own element",
        ScanLostCarry "the carry into the 257th element's chunk is lost",
        ScanLostLateCarry "the carry between the first 65536 elements and the rest is lost",
        ScanLastElement "the last offset is not written",
        ScanTotalWithoutLast "the total leaves out the last element",
        ScanSaturates "sums saturate instead of wrapping",
        ScanAcceptsLengths "unequal lengths are accepted";
    "sort":
        SortUnstable "the first two equal neighbours change places",
        SortSkipsPass "the highest eight bits of u32 keys are not sorted by",
        SortSkipsMiddlePass "bits 32 to 39 of u64 keys are not sorted by",
        SortKeepsPayload "keys move and payload stays",
        SortDescending "the order is descending",
        SortDropsLast "the last pair is not sorted",
        SortSigned "u32 keys compare as signed",
        SortAcceptsLengths "unequal lengths are accepted";
    "rasterize_lhb":
        LhbEdgesInclusive "centres on any edge are covered",
        LhbEdgesExclusive "centres on edges are not covered",
        LhbBottomRight "edges at the bottom and right own their centres, those at the top and left don't",
        LhbTruncatesScreen "screen coordinates are rounded down",
        LhbEdgeOnDrawn "triangles seen edge-on are drawn a sub-pixel wide",
        LhbEdgeOverflow "edge functions wrap at 29 bits",
        LhbCullsSmall "triangles with one pixel in their bounds are lost",
        LhbLosesBlock "the last 4 x 4 block of large triangles is empty",
        LhbLosesLastTriangle "the last triangle beyond 256 is lost",
        LhbLosesLastLayer "the last layer of lists of more than three is lost",
        LhbMergesCopies "of equal surfaces at equal depth one is kept",
        LhbTiesToHigher "equal depths go by falling number",
        LhbLongUnsorted "lists of more than 64 are sorted in parts",
        LhbFarFirst "lists run from far to near",
        LhbFacingInverted "fronts and backs change places",
        LhbAlwaysFront "every surface shows its front",
        LhbCullsBacks "backs are culled",
        LhbNearestVertex "depth is the nearest vertex's",
        LhbFlatRows "depth does not change along rows",
        LhbUnclamped "depth is not clamped to the corners'",
        LhbRoundsDown "gradients of depth are rounded down",
        LhbPathBits "spans lose a unit of depth",
        LhbPathLosesPixel "runs lose the last pixel of a triangle's bounds",
        LhbCapKeepsNear "the cap keeps what is near, whatever the side",
        LhbCapOff "caps keep one element less",
        LhbLeftOutZero "nothing counts as left out",
        LhbOffsetsInclusive "offsets are ends of lists, not beginnings",
        LhbViewsReversed "the last view comes first",
        LhbFirstViewOnly "every view is the first",
        LhbTransposed "rows and columns change places",
        LhbUpsideDown "rows run from the bottom",
        LhbAcceptsAnything "parameters are not checked";
    "merge_lhb":
        MergeTiesToAdded "of equal depths the added go first",
        MergeTiesByNumber "of equal depths the lower number goes first",
        MergeAppends "added elements stand behind the kept ones",
        MergeSigned "depths compare as signed",
        MergeDropsCopies "of equal depths one is kept",
        MergeLongUnsorted "lists of more than 65536 elements are merged up to there",
        MergeStale "what the call before added is added again",
        MergeNeighbour "the next pixel's list is added",
        MergeTransposed "added rows and columns change places",
        MergeFirstViewOnly "the first view is added to every view",
        MergeLosesCommonLast "of lists that both have, the last added element is lost",
        MergeLosesLoneAdded "lists that the added alone have are lost",
        MergeEndsWithKept "what is added behind the last kept element is lost",
        MergeCopiesLoneAdded "where nothing is kept, what is added is not renumbered",
        MergeNotRenumbered "added triangles keep their numbers",
        MergeRenumbersOffByOne "added triangles are numbered one too low",
        MergeRenumbersSurfaces "surfaces move by one per triangle",
        MergeRenumbersAll "kept triangles are renumbered too",
        MergeLosesFacing "added triangles show their backs",
        MergeSaturates "numbers saturate instead of wrapping",
        MergeIgnoresCap "the cap is ignored",
        MergeCapOff "caps keep one element less",
        MergeCapPerPart "the cap counts for either part",
        MergeCapKeepsNear "the cap keeps what is near, whatever the side",
        MergeCapKeepsFar "the cap keeps what is far, whatever the side",
        MergeForgetsLeftOutOfAdded "what the added left out is forgotten",
        MergeForgetsLeftOutOfKept "what the kept left out is forgotten",
        MergeForgetsWhatItCuts "what is cut off is not counted",
        MergeLeftOutSaturates "numbers left out saturate instead of wrapping",
        MergeTrustsOffsets "offsets that fall are trusted",
        MergeAcceptsAnything "shapes and parameters are not checked";
    "pack_lhb":
        PackRoundsDepth "depths go to the nearest bin's beginning",
        PackWrapsDepth "depths beyond the last bin wrap",
        PackTwelveBits "bins are twice as deep",
        PackDepthLast "depth is in the lowest bits",
        PackLosesFacing "every surface shows its front",
        PackInvertsFacing "fronts and backs change places",
        PackLosesBit "numbers lose their highest bit",
        PackSortsWords "equal bins go by number",
        PackLosesLast "the last word beyond 256 is not written",
        PackLosesLayer "the last layer stays empty",
        PackLayerByLayer "layers stand one behind the other",
        PackEmptyIsZero "layers without an element are 0",
        PackKeepsNear "layers keep what is near, whatever the side",
        PackKeepsFar "layers keep what is far, whatever the side",
        PackFarFirst "far layers run from far to near",
        PackForgetsWhatItCuts "what layers have no room for is not counted",
        PackForgetsLeftOut "what was left out before is forgotten",
        PackLeftOutSaturates "numbers left out saturate instead of wrapping",
        PackCutsTriangles "numbers beyond the limit are cut",
        PackTrustsOffsets "offsets that fall are trusted",
        PackAcceptsAnything "shapes and parameters are not checked",
        UnpackReadsNearest "depth is read back as the bin's nearest",
        UnpackReadsEmpty "layers without an element are elements",
        UnpackLosesLayer "the last layer is not read back",
        UnpackForgetsLeftOut "what was left out is forgotten on the way back",
        UnpackAcceptsAnything "shapes of words are not checked";
    "query_lhb":
        QueryNoWindow "what is within the window is passed without a look at planes",
        QueryWindowAheadOnly "the window reaches ahead only",
        QueryWindowBehind "the window reaches behind without end",
        QueryWindowInclusive "at the window's end depths decide",
        QueryDepthsOnly "within the window depths decide",
        QueryOwnTriangle "the triangle that is left can be met",
        QueryAnySide "surfaces are entered from both sides",
        QuerySideInverted "surfaces are entered on the side that was not left",
        QueryFacingKept "facing is not inverted for reversed rays",
        QueryFacingAlwaysInverted "facing is inverted for all rays",
        QueryNoClearance "a position on a plane is before it",
        QueryClearanceInclusive "eight steps are enough of a clearance",
        QueryClearanceOneSided "backs need no clearance",
        QueryOrderKept "reversed rays read their list from its nearest element",
        QueryTiesByNumber "of equal depths the lower triangle comes first, reversed or not",
        QueryLastAhead "the farthest surface ahead is met",
        QueryIgnoresOffset "offsets are ignored",
        QueryOffsetInPixels "offsets count pixels",
        QueryWraps "positions beyond the image wrap round",
        QueryTransposed "rows and columns change places",
        QueryViewOffByOne "the next view answers",
        QueryLastViewOnly "views beyond the last are the last",
        QueryReversedIsView "the direction's number is the view's",
        QueryDepthOfPixel "depth is counted from the viewer",
        QueryLongLists "lists end after 64 elements",
        QueryLosesLast "the last query beyond 256 is not answered",
        QueryAcceptsLengths "unequal lengths are accepted";
    "trace":
        TraceTieToHigherId "of equally near triangles the highest id is named",
        TraceCullsBackFaces "back faces are not met",
        TraceIgnoresMin "t_min counts as 0",
        TraceIgnoresMax "t_max counts as infinite",
        TraceMaxExclusive "a hit at t_max is refused",
        TraceMissesTriangles "every 61st triangle is invisible",
        TraceEdgesExclusive "rays through edges and corners miss",
        TraceSwapsWeights "u and v change places",
        TraceNormalizesDirections "t counts world units",
        TraceWrongMissDistance "t of a miss is 0",
        TraceSlotForId "the slot is reported in place of the id",
        TraceLastRay "the last ray of a batch over 64 is not traced",
        TraceAnyInverted "occlusion is inverted",
        TraceAnyIgnoresMax "occlusion ignores t_max";
    "shade_primary":
        ShadeCornerOfPixel "rays go through the pixel's corner",
        ShadeUpsideDown "rows run from the bottom",
        ShadeNormalFollowsWinding "the geometric normal does not face the camera",
        ShadeNormalAway "the shading normal faces away",
        ShadeFlat "vertex normals are not interpolated",
        ShadeLongNormals "shading normals are 1 % too long",
        ShadeWrongMaterial "the material is the next one",
        ShadeDistanceForDepth "depth is the distance from the eye",
        ShadeUntextured "textures are left out",
        ShadeGamma "albedo is gamma-encoded",
        ShadeMissesTriangles "every seventh triangle is invisible",
        ShadeNothingIsFar "depth of nothing is infinite",
        ShadeAcceptsLengths "a buffer of another size is accepted";
    "trace_paths":
        PathsLoseBounce "one bounce less than asked for",
        PathsStopEarly "paths end after three bounces",
        PathsDoubleDirect "direct light counts twice",
        PathsDropIndirect "indirect light is lost",
        PathsBias "two percent of the light is lost",
        PathsAlbedoBias "albedo is three percent too low",
        PathsEmitterBias "emission met by rays is three percent too bright",
        PathsLightPdf "the light's selection probability is wrong",
        PathsTriangleArea "the density on emissive triangles is wrong",
        PathsSphereRadius "sphere lights are three percent too small",
        PathsHardSpot "spot lights have no falloff",
        PathsNoOffset "bounced rays and shadow rays start on the surface and meet it",
        PathsLongOffset "bounced rays and shadow rays start beyond what is close to the surface",
        PathsMirrorWithoutTint "mirrors reflect everything",
        PathsFixedIor "every glass has index 1.5",
        PathsWrongLobe "the lobe's shadowing is wrong",
        PathsNoGrazing "the lobe does not brighten at grazing angles",
        PathsIgnoreFirstSample "sample ranges start at 0",
        PathsIgnoreSeed "the seed is ignored",
        PathsIgnoreSampler "the sampler is ignored",
        PathsWholeImage "the pixel range is ignored",
        PathsOverwriteFilm "sums are overwritten instead of added to",
        PathsLoseCarry "the carry between the words of a sum is lost",
        PathsLoseSpread "squares are not summed",
        PathsCountTwice "one sample too many is counted",
        PathsSwapChannels "red and blue change places",
        PathsShadowsAnyway "triangles shadow where the scene says that they don't",
        PathsReject "sound samples are counted as rejected",
        PathsAcceptAnything "parameters are not checked";
    "walk_lhb":
        WalkLoseBounce "one bounce less than asked for",
        WalkStopEarly "paths end after two bounces",
        WalkDoubleDirect "direct light counts twice",
        WalkDropIndirect "indirect light is lost",
        WalkAlbedoBias "albedo is three percent too low",
        WalkEmittersTwice "emissive triangles are counted half as much again",
        WalkEmittersWeighted "emissive triangles are counted a fifth too little",
        WalkSpheresUnseen "sphere lights are not met by scattered rays",
        WalkEnvironmentLost "the environment is lost",
        WalkTraces "scattered rays are traced",
        WalkLosesMisses "rays whose lookup finds nothing leave the scene",
        WalkNoCone "the cone approximation is left out",
        WalkNoLift "rays below their surface are not lifted",
        WalkNoGather "directions are drawn where all are asked for",
        WalkNoPatterns "interleaved pixels draw numbers of their own",
        WalkWrongTriangle "the triangle after the one that is met is shaded",
        WalkFirstLayer "lists end after their first element",
        WalkFacing "fronts and backs change places",
        WalkAgainst "directions are looked up the wrong way round",
        WalkViewOffByOne "the next view answers",
        WalkScale "lattice steps are five percent too long",
        WalkOffCentre "the lattice's centre is left out",
        WalkShadowsNever "nothing shadows light whose shadow rays are looked up",
        WalkShadowsAlways "light whose shadow rays are looked up never arrives",
        WalkShadowsMargin "lamps shadow themselves: the margin is on the wrong side",
        WalkShadowsFirst "first vertices look shadows up unasked",
        WalkShadowsTraced "shadow rays are traced where lookups are asked for",
        WalkShadowsLast "light that waits at the last vertex of a path is lost",
        WalkShadowsAnyway "triangles shadow where the scene says that they don't",
        WalkIgnoreFirstSample "sample ranges start at 0",
        WalkOneSample "one sample is taken, however many are asked for",
        WalkIgnoreSeed "the seed is ignored",
        WalkIgnoreSampler "the sampler is ignored",
        WalkWholeImage "the pixel range is ignored",
        WalkFixedExponent "the film's exponent is fixed",
        WalkOverwriteFilm "sums are overwritten instead of added to",
        WalkAcceptAnything "parameters are not checked";
    "filter_indirect":
        FilterCopies "nothing is averaged",
        FilterBox "the border of even windows weighs as much as their inside",
        FilterQuarters "the border of even windows weighs a quarter",
        FilterNarrow "even windows have no border",
        FilterWide "windows reach a pixel farther",
        FilterAhead "even windows lack their right and lower border",
        FilterCapped "windows end after 15 pixels",
        FilterClamps "pixels at the picture's border stand in for those beyond it",
        FilterWraps "rows go on in the next one",
        FilterDropsBorder "pixels at the picture's border are nobody's neighbours",
        FilterSeparated "rows are averaged first and columns of the result after",
        FilterInPlace "neighbours that have been averaged are averaged again",
        FilterWholeWindow "the sum is divided by the whole window's weight",
        FilterDividesByNothing "where no neighbour counts, the sum is divided by 0",
        FilterNothing "pixels that show nothing are averaged",
        FilterJoinsNothing "pixels that show nothing are joined with material 0",
        FilterGlossy "materials that are not diffuse are averaged",
        FilterTrustsMaterials "materials without an entry are averaged",
        FilterIgnoresMaterials "other materials are joined",
        FilterIgnoresNormals "surfaces that face elsewhere are joined",
        FilterFlatNormals "geometric normals are compared",
        FilterAnySide "opposite normals are joined",
        FilterCosineExclusive "a cosine of exactly the limit is too little",
        FilterIgnoresPlanes "surfaces behind each other are joined",
        FilterPlaneExclusive "a height of exactly the limit is too much",
        FilterShadingPlane "planes have the shading normal",
        FilterNeighboursPlane "the plane is the neighbour's",
        FilterOneSidedPlane "whatever is behind the plane is near it",
        FilterDistance "distances are measured to points, not to planes",
        FilterLimitPerPixel "the limit does not grow with the window",
        FilterLimitWithoutDepth "the limit does not grow with depth",
        FilterNeighboursDepth "the limit grows with the neighbour's depth",
        FilterBlursTextures "light is averaged with its albedo",
        FilterLosesAlbedo "irradiance comes out",
        FilterDims "a thousandth of the light is lost",
        FilterBlackens "channels without albedo become black",
        FilterCountsBlack "neighbours without albedo count as dark",
        FilterLeastIsTooLittle "the least albedo is too little",
        FilterOneChannelDecides "red decides for all channels whether there is albedo",
        FilterSwapsChannels "red and blue change places",
        FilterMasks "neighbours that are not joined count 0 times their light",
        FilterDropsInfinite "light that is not finite is dropped",
        FilterAdds "light is added to what the output held",
        FilterKeepsPadding "padding is what it was",
        FilterLosesLast "the last pixel beyond 257 is not written",
        FilterAcceptsAnything "lengths and parameters are not checked";
    "reduce_mips":
        MipsStartsOff "levels above the first start one value late",
        MipsRanksPerLevel "ranks begin at 0 on every level",
        MipsRanksInclusive "ranks count their own word",
        MipsLosesParent "the last parent is not marked",
        MipsUpperChildren "parents with children in their upper half alone are not marked",
        MipsDescends "codes descend",
        MipsParentOfSixteen "codes lose four bits from level 0 to level 1",
        MipsLosesTop "the last level is empty",
        MipsLosesLast "the last of more than 256 parents is not written",
        MipsSwapsHalves "children of the lower and the upper half change places",
        MipsSwapsAxes "y and z change places",
        MipsWeighsLeaves "leaves are premultiplied again",
        MipsRoundsDown "eighths are rounded down",
        MipsDividesByThoseThere "sums are divided by the children that there are",
        MipsQuarters "sums of eight are divided by four",
        MipsBackFirst "what is behind covers what is before it",
        MipsUnweighed "what is behind is seen through what is opaque",
        MipsCoversByBack "what is behind is weighed by its own opacity",
        MipsAlmostOpaque "opacity 1 is a unit less",
        MipsBehindRounds "what is behind is rounded to the nearest",
        MipsColumnsRoundDown "means of columns are rounded down",
        MipsColumnsOfEight "columns are divided by eight",
        MipsWithoutPi "lobes are not divided by pi",
        MipsFarForNear "near and far solid angles change places",
        MipsHalvesGradient "a constant gives half its gradient",
        MipsKeepsGradient "gradients are kept whole",
        MipsFloors "products of harmonics are rounded down, below 0 too",
        MipsScalesRounded "products of harmonics are rounded to the nearest",
        MipsTruncates "eighths of harmonics are rounded towards 0",
        MipsHalvesUp "halves of harmonics are rounded up, below 0 too",
        MipsExponentTooSmall "exponents are one too small",
        MipsExponentTooLarge "exponents are one too large",
        MipsForgetsExponent "exponents are not stored",
        MipsBytesTruncate "bytes are rounded towards 0",
        MipsBytesReversed "the first byte is the highest",
        MipsBytesSigned "bytes saturate at 127",
        MipsLosesCarry "carries into a sum's high word are lost",
        MipsHighFirst "a sum's high word comes first",
        MipsMissingIsLeast "missing children count as 0 in ranges",
        MipsRangeOfLeast "ranges end where they begin",
        MipsAcceptsAnything "lengths and storages are not checked";
    "voxelize":
        VoxelDepthClosed "depth is closed on both sides",
        VoxelDepthUpper "walls in a face's plane are in the lower voxel",
        VoxelHeightsOnEdges "heights are taken on voxels' edges",
        VoxelDominantLast "of equal components of the normal the last one dominates",
        VoxelAlongZ "planes are crossed along z, whatever dominates",
        VoxelOtherEdges "the projection along x has the edges of the one along y",
        VoxelTurned "triangles seen from behind are inside out",
        VoxelNoEdges "edges are not tested",
        VoxelDominantEdges "edges are tested along the dominant axis only",
        VoxelNarrowEdges "edges reach half a voxel along their shorter step",
        VoxelSharpEdges "edges reach centres only",
        VoxelWideEdges "edges reach cubes' corners",
        VoxelEdgeWraps "edge functions wrap at 30 bits",
        VoxelEdgeWrapsEarly "edge functions wrap at 17 bits",
        VoxelNoMargin "conservative cubes have no margin",
        VoxelWideMargin "conservative cubes have twice the margin",
        VoxelOpenCubes "conservative cubes are open",
        VoxelOneSided "axes are compared on one side",
        VoxelNoPlane "the plane separates nothing",
        VoxelNoProducts "products of edges separate nothing",
        VoxelLosesSegments "conservative voxels of triangles without area are lost",
        VoxelAlwaysThin "conservative voxels are thin ones",
        VoxelAlwaysConservative "thin voxels are conservative ones",
        VoxelLosesLast "the last voxel along x is never met",
        VoxelLosesRow "the last row of large triangles' cells is lost",
        VoxelLosesLarge "large triangles meet nothing",
        VoxelLosesLastTriangle "the last triangle beyond 1024 meets nothing",
        VoxelUnclamped "triangles that leave the box are lost",
        VoxelRoundsTwice "coordinates are half a unit too high",
        VoxelSwapsAxes "x and y change places in codes",
        VoxelMirrorsBits "bits of words run backwards",
        VoxelRanksInclusive "ranks count their own word",
        VoxelRanksWithoutTotal "the number of all bits is missing",
        VoxelActiveByRows "active voxels are in the order of rows",
        VoxelActiveLosesLast "the last active voxel is not listed",
        VoxelParentTwice "a parent is listed twice",
        VoxelCutoffOff "triangles of as many cells as the cutoff are large",
        VoxelCellsOfBounds "classes go by the voxels of the bounds",
        VoxelClassesEmpty "thin triangles without area have a class",
        VoxelLargeBackwards "large triangles are listed from the last",
        VoxelAcceptsAnything "grids and parameters are not checked";
    "sum_voxels":
        SumNegativeWeights "centres beside a triangle give negative weights",
        SumAlongZ "centres are projected along z, whatever dominates",
        SumTurnsCorners "weights are those of the next corner",
        SumRestToLast "the last corner has what rounding leaves",
        SumShortWeights "areas keep 16 bits",
        SumLongWeights "areas keep 18 bits",
        SumRoundsWeights "weights are rounded to the nearest",
        SumNoAreaUnweighed "triangles without area count as their first corner",
        SumNormalsDown "normals are rounded down",
        SumNormalsToZero "normals are rounded towards 0",
        SumUnsignedNormals "normals have no sign",
        SumFirstCorner "normals are the first corner's",
        SumTransposesTexels "rows and columns of textures change places",
        SumFirstTexture "every texture begins with the first texel",
        SumRoundsTexels "the nearest texel's corner decides",
        SumTexelsUp "texture coordinates are rounded up",
        SumWraps "texture coordinates always wrap",
        SumClamps "texture coordinates are always clamped",
        SumUntexturedIsBlack "surfaces without a texture are black",
        SumIgnoresTint "every surface is as bright as its texture",
        SumAlbedoDown "albedos are rounded down",
        SumWhiteIs1024 "texels are 1024ths",
        SumSwapsChannels "red and blue change places",
        SumEmissionOnce "emission counts once per voxel",
        SumLastFragment "the last fragment counts alone",
        SumDoublesLarge "large triangles count twice",
        SumThin "conservative voxels are summed as thin ones",
        SumLosesLast "the last sums beyond 64 are 0",
        SumAverages "sums are divided by their number",
        SumCountSaturates "numbers of fragments end at 16 bits",
        SumPadding "padding is not 0",
        SumAcceptsOverflow "more fragments than sums have room for are accepted",
        SumAcceptsAnything "lengths and parameters are not checked";
    "trace_cones":
        ConesTooFine "levels are one too fine",
        ConesWrongBits "the weight of the coarser level is of the wrong bits",
        ConesOneLevel "the coarser level is left out",
        ConesHalfAVoxelOff "voxels are sampled at their corners",
        ConesSwapAxes "weights along x and z change places",
        ConesEmptyBorder "beyond the border is nothing",
        ConesGoOnOutside "cones go on beyond the grid",
        ConesEndAtBorder "cones end with the last sample in the grid",
        ConesLookOutside "samples beyond the border are not brought in",
        ConesSwapFaces "light comes from the faces behind",
        ConesUnsquared "faces weigh as much as directions, not as their squares",
        ConesAlong "harmonics are read along the cone, not against it",
        ConesNegative "harmonics below zero take light away",
        ConesUnsignedBytes "bytes have no signs",
        ConesIgnoreExponent "bytes have no exponent",
        ConesNoLayers "means of opacity are opacities",
        ConesLayersForAll "opacities through faces are means",
        ConesLayersDarken "layers have opacity and no light",
        ConesLightThemselves "surfaces light and shadow themselves",
        ConesCentresOnly "voxels are in front where their centres are",
        ConesNotDivided "what is behind the surface counts as empty",
        ConesUnattenuated "what is in front hides nothing",
        ConesAnyOpacity "opacities beyond 1 count",
        ConesEndEarly "cones end when a sixteenth is left",
        ConesFewSteps "cones end after 256 samples",
        ConesAnySine "sines have no limit below 1",
        ConesOverlap "spheres overlap by half",
        ConesSpheresApart "spheres do not grow on their way",
        ConesSixtyTriples "cones of 60 degrees triple their distance",
        ConesSixtyUnaligned "cones of 60 degrees begin between levels",
        ConesIgnoreReach "cones have no reach",
        ConesIgnoreStart "cones start at their apex",
        ConesIgnoreUnit "light has no unit",
        ConesLoseLast "the last cone beyond 64 is not traced",
        ConesNeighbour "the 257th cone has the light of the first",
        ConesAcceptAnything "parameters are not checked";
    "light_voxels":
        LightOneSide "light from behind a surface is lost",
        LightNoCosine "light is not weighed by its cosine",
        LightNoPi "albedo is not divided by π",
        LightFullWithoutNormal "voxels without a normal face every light",
        LightBlackWithoutNormal "voxels without a normal are black",
        LightShadowsAnyway "triangles shadow where the scene says that they don't",
        LightNoShadow "nothing is in between",
        LightTrianglesDontShadow "triangles are in nobody's way",
        LightSpheresDontShadow "spheres are in nobody's way",
        LightShadowedFromBeyond "rays don't end at their light",
        LightNoLift "rays begin in the middle of the voxel",
        LightLiftsAlongNormal "rays begin on the normal's side",
        LightLiftsAway "rays begin on the side away from the light",
        LightLiftsFar "rays begin a voxel from the middle",
        LightSkipsLastSample "the last sample is not taken",
        LightSumsSamples "samples are not divided by their number",
        LightForgetsSelection "the chance of choosing a light is forgotten",
        LightFirstLightOnly "the first light stands for all",
        LightIgnoresSeed "the seed is ignored",
        LightIgnoresCode "all voxels draw the same numbers",
        LightLosesGathered "what was gathered is lost",
        LightGatheredPerSample "what was gathered is divided by the number of samples",
        LightGatheredWithoutAlbedo "what was gathered leaves as it came",
        LightEmissionAddsUp "emission is not divided by the number of fragments",
        LightEmissionUnscaled "emission has no unit",
        LightAlbedoAddsUp "albedo is not divided by the number of fragments",
        LightAlbedoOf4096 "albedo 1 is 4096",
        LightAlbedoAtMostOne "albedo beyond 1 is cut",
        LightCornerOfVoxel "voxels are their corners",
        LightSwapsAxes "x and z change places",
        LightTransparent "opacity is 0",
        LightEmptyIsOpaque "voxels without fragments are opaque",
        LightTruncates "radiance is rounded down",
        LightWithoutLimit "radiance has no limit",
        LightReverses "leaves stand in the reverse order",
        LightLosesLast "the last voxel beyond 256 is not written",
        LightAcceptsAnything "lengths and parameters are not checked";
}

impl Fault {
    /// Whether it is one of a kernel's.
    pub fn sits_in(self, kernel: &str) -> bool {
        FAULTS.iter().any(|(fault, of, _)| *fault == self && *of == kernel)
    }
}

/// A bug the suite did not see.
#[derive(Debug, Clone)]
pub struct Uncaught {
    /// Which.
    pub fault: Fault,
    /// Where it sits.
    pub kernel: &'static str,
    /// What it does.
    pub story: &'static str,
}

/// What the trials run with: whether one fails is asked, not on how small an input.
fn options(kernel: &str, seed: u64) -> Options {
    Options {
        effort: Effort::Quick,
        seed,
        kernels: vec![kernel.to_owned()],
        first_evidence: true,
        ..Options::default()
    }
}

fn fails(trial: &Trial<'_>, info: &BackendInfo) -> bool {
    matches!(judge(&[], info, &trial.name, trial.run()), Verdict::Failed(_))
}

/// Names of `kernel`'s trials, the cheapest first, as they run on `backend` wrapped with no bug planted.
///
/// # Errors
/// The first trial that fails.
pub fn passing<B: Backend + Sync>(backend: &B, kernel: &str, seed: u64) -> Result<Vec<String>, String> {
    let (options, faulty) = (options(kernel, seed), Faulty::new(backend, Fault::None));
    let mut timed = Vec::new();
    for trial in suite(&faulty, &options) {
        let start = Instant::now();
        if fails(&trial, &backend.info()) {
            return Err(trial.name);
        }
        timed.push((start.elapsed(), trial.name));
    }
    timed.sort();
    Ok(timed.into_iter().map(|(_, name)| name).collect())
}

/// Runs `fault`'s kernel's trials on `backend` with the bug planted and returns the first trial that fails. Those named in `order`
/// run in it, before the others: most bugs show in what is cheap.
pub fn caught_by<B: Backend + Sync>(
    backend: &B,
    fault: Fault,
    kernel: &str,
    seed: u64,
    order: &[String],
) -> Option<String> {
    let (options, faulty) = (options(kernel, seed), Faulty::new(backend, fault));
    let mut trials = suite(&faulty, &options);
    trials.sort_by_key(|trial| order.iter().position(|name| *name == trial.name).unwrap_or(order.len()));
    trials.iter().find(|trial| fails(trial, &backend.info())).map(|trial| trial.name.clone())
}

/// The bugs that the suite does not see in `backend`.
pub fn uncaught<B: Backend + Sync>(backend: &B, seed: u64) -> Vec<Uncaught> {
    FAULTS
        .iter()
        .filter(|(fault, kernel, _)| caught_by(backend, *fault, kernel, seed, &[]).is_none())
        .map(|&(fault, kernel, story)| Uncaught { fault, kernel, story })
        .collect()
}
