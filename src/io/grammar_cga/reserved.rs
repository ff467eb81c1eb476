//! Words that mean something in CGA, by the index of its reference
//! (<https://esri.github.io/cityengine-sdk/html/cgaref/cgareference/cgaindex.html>), up to CityEngine 2026.0.

/// Keywords, literals and the names of axes.
const KEYWORDS: &str = "attr const extension import start style with version case else true false null \
    inline union subtract intersect x y z u v xy xz yz xyz";

/// Shape operations.
const OPERATIONS: &str = "i extrude envelope taper roofGable roofHip roofPyramid roofRidge roofShed offset \
    primitiveQuad primitiveDisk primitiveCube primitiveSphere primitiveCylinder primitiveCone insertAlongUV \
    footprint split splitArea splitAndSetbackPerimeter comp innerRectangle innerRect setback setbackPerEdge \
    setbackToArea shapeL shapeU shapeO scatter cleanupGeometry convexify deleteHoles reverseNormals \
    softenNormals setNormals mirror rectify reduceGeometry resetGeometry trim modify tag deleteTags \
    setTagsFromEdgeAttrs texture setupProjection projectUV translateUV scaleUV normalizeUV tileUV rotateUV \
    deleteUV copyUV t translate s r rotate center alignScopeToAxes alignScopeToGeometry \
    alignScopeToGeometryBBox rotateScope setPivot mirrorScope pop push NIL label set color resetMaterial \
    setMaterial report print";

/// Shape attributes and the first words of dotted names.
const ATTRIBUTES: &str =
    "comp initialShape material pivot scope seedian split trim geometry edgeAttr";

/// Functions, with those of the utility library.
const FUNCTIONS: &str = "abs acos asin atan atan2 ceil cos exp floor isinf isnan ln log10 pow rint sin sqrt tan \
    p rand bool boolArray float floatArray isNull sel str stringArray count find len splitString substring \
    getMaterial readMaterial fileExists fileSearch filesSearch readFloatTable readStringTable readTextFile \
    assetInfo assetMetadata assetNamingInfo assetNamingInfos assetsSortRatio assetsSortSize imageInfo \
    imagesSortRatio inside overlaps touches minimumDistance contextCompare contextCount findFirst index item \
    nColumns nRows setElems size sortIndices sortRowIndices sum transpose convert getGeoCoord getTreeKey \
    findLast getPrefix getRange getSuffix replace listAdd listClean listCount listFirst listFromArray \
    listIndex listItem listLast listRandom listRange listRemove listRemoveAll listRetainAll listSize \
    listTerminate listToArray assetApproxRatio assetApproxSize assetBestRatio assetBestSize assetFitSize \
    fileBasename fileDirectory fileExtension fileName fileRandom imageApproxRatio imageBestRatio clamp max min \
    colorHexToB colorHexToG colorHexToH colorHexToO colorHexToR colorHexToS colorHexToV colorHSVToHex \
    colorHSVOToHex colorRamp colorRGBToHex colorRGBOToHex";

/// Operations that change how a shape looks, or nothing, and not where it is: a reader may skip them.
const APPEARANCE: &str = "color set setMaterial resetMaterial texture setupProjection projectUV translateUV \
    scaleUV normalizeUV tileUV rotateUV deleteUV copyUV label report print tag deleteTags";

/// Operations that end a leaf: what they put into a shape is not divided further.
const FILLING: &str = "i extrude primitiveQuad primitiveDisk primitiveCube primitiveSphere primitiveCylinder \
    primitiveCone";

/// Every reserved word; some stand there twice.
pub fn words() -> impl Iterator<Item = &'static str> {
    let lists = [KEYWORDS, OPERATIONS, ATTRIBUTES, FUNCTIONS];
    lists.into_iter().flat_map(str::split_ascii_whitespace)
}

/// True if an operation may be skipped before a split or a symbol.
pub(super) fn is_appearance(operation: &str) -> bool {
    APPEARANCE.split_ascii_whitespace().any(|o| o == operation)
}

/// True if an operation may stand in a leaf.
pub(super) fn is_leaf_operation(operation: &str) -> bool {
    is_appearance(operation) || FILLING.split_ascii_whitespace().any(|o| o == operation)
}
