// The page of CesiumJS: draws a tileset from above at 45 degrees and reads Cesium's own statistics.

/* global Cesium */
/** Metres from the middle of the earth from which on a tileset stands on it. */
const EARTH = 6.2e6;

Cesium.Ion.defaultAccessToken = undefined;
const widget = new Cesium.CesiumWidget(document.body.appendChild(document.createElement("div")), {
  baseLayer: false,
  globe: false,
  skyBox: false,
  skyAtmosphere: false,
  scene3DOnly: true,
  useDefaultRenderLoop: false,
  creditContainer: document.createElement("div"),
  contextOptions: { webgl: { preserveDrawingBuffer: true } },
});
const { scene, camera } = widget;
scene.rethrowRenderErrors = true;
scene.backgroundColor = Cesium.Color.fromCssColorString(globalThis.BACKGROUND);
camera.frustum.fov = Math.PI / 4;
let tileset;

/** Turns camera and sun to a sphere given by its middle, in the tileset's coordinates, and radius. */
function face([x, y, z, radius]) {
  const middle = Cesium.Matrix4.multiplyByPoint(tileset.modelMatrix, new Cesium.Cartesian3(x, y, z), new Cesium.Cartesian3());
  const place = Cesium.Transforms.eastNorthUpToFixedFrame(middle);
  camera.lookAtTransform(place, new Cesium.HeadingPitchRange(0, -Math.PI / 4, radius / Math.sin(Math.PI / 8)));
  scene.light = new Cesium.DirectionalLight({
    direction: Cesium.Matrix4.multiplyByPointAsVector(place, new Cesium.Cartesian3(2, 1, -3), new Cesium.Cartesian3()),
  });
}

/** Draws until `holds` five times in turn. */
async function draw(deadline, holds) {
  const end = Date.now() + deadline;
  let quiet = 0;
  while (quiet < 5) {
    if (Date.now() > end) throw new Error(`not everything was loaded in ${deadline / 1000} s`);
    widget.resize();
    widget.render();
    quiet = holds() ? quiet + 1 : 0;
    await new Promise((done) => setTimeout(done, 20));
  }
}

/** Loads and draws the tileset, seen as the other viewer sees it. */
globalThis.check = async (url, deadline, sphere) => {
  const failed = [];
  tileset = await Cesium.Cesium3DTileset.fromUrl(url, {
    maximumScreenSpaceError: 0.01,
    dynamicScreenSpaceError: false,
    foveatedScreenSpaceError: false,
    cacheBytes: 4e9,
    maximumCacheOverflowBytes: 4e9,
  });
  tileset.tileFailed.addEventListener((e) => failed.push(`${e.url}: ${e.message}`));
  const middle = new Cesium.Cartesian3(...sphere);
  if (Cesium.Cartesian3.magnitude(middle) < EARTH) {
    // Cesium takes coordinates as those of the earth; a tileset in other metres is put on it, its middle at 0 north, 0 east.
    const place = Cesium.Transforms.eastNorthUpToFixedFrame(Cesium.Cartesian3.fromDegrees(0, 0));
    const back = Cesium.Matrix4.fromTranslation(Cesium.Cartesian3.negate(middle, new Cesium.Cartesian3()));
    tileset.modelMatrix = Cesium.Matrix4.multiply(place, back, new Cesium.Matrix4());
  }
  scene.primitives.add(tileset);
  face(sphere);
  await draw(deadline, () => failed.length > 0 || tileset.tilesLoaded);
  const { selected, numberOfTrianglesSelected } = tileset.statistics;
  return { tiles: selected, triangles: numberOfTrianglesSelected, failed };
};

/** Draws the loaded tileset as seen from nearer. */
globalThis.approach = async (sphere, deadline) => {
  face(sphere);
  await draw(deadline, () => tileset.tilesLoaded);
};
