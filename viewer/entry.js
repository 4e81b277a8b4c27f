// What a page takes of three.js to turn surfaces: a surface, and lines of a width in pixels.
export {
  BufferAttribute, BufferGeometry, DataTexture, DoubleSide, FloatType, FrontSide, Mesh, OrthographicCamera, RGBAFormat,
  Raycaster, Scene, ShaderMaterial, Sphere, Vector2, Vector3, WebGLRenderer,
} from "three";
export { LineMaterial } from "three/addons/lines/LineMaterial.js";
export { LineSegments2 } from "three/addons/lines/LineSegments2.js";
export { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
