// SPDX-License-Identifier: MIT
// The stage: renderer, light, table, and when to draw. Nothing is drawn while nothing changes.
import * as THREE from './three.module.js';
import {Orbit} from './orbit.js';
import {onThemeChange, sceneColors} from './theme.js';

const SLOW = 1 / 22;       // s from asking for a picture to its turn: later than this is late
const PATIENCE = 2;        // s
const REST = 400;          // ms
const TABLE_RADIUS = 1.6, SHADOW_REACH = 0.34;  // m

const BACKDROP = {
  depthTest: false, depthWrite: false,
  uniforms: {sky: {value: new THREE.Color()}, horizon: {value: new THREE.Color()}},
  vertexShader: 'varying vec2 at; void main() { at = position.xy; gl_Position = vec4(position.xy, 1.0, 1.0); }',
  fragmentShader: `uniform vec3 sky, horizon; varying vec2 at;
    void main() { gl_FragColor = vec4(mix(sky, horizon, smoothstep(0.1, 1.5, length(at * vec2(0.8, 1.0) - vec2(0.0, 0.25)))), 1.0); }`,
};

// A round table with a line every 100 mm that fades into the backdrop. From below half of what is on it is seen through it.
const tableMaterial = (radius) => new THREE.ShaderMaterial({
  transparent: true, depthWrite: false, side: THREE.DoubleSide,
  uniforms: {color: {value: new THREE.Color()}, line: {value: new THREE.Color()}, center: {value: new THREE.Vector3()}, radius: {value: radius}},
  vertexShader: `varying vec3 at; void main() { vec4 world = modelMatrix * vec4(position, 1.0); at = world.xyz;
    gl_Position = projectionMatrix * viewMatrix * world; }`,
  fragmentShader: `uniform vec3 color, line, center; uniform float radius; varying vec3 at;
    void main() {
      vec2 cell = at.xz / 0.1, from = abs(fract(cell - 0.5) - 0.5) / fwidth(cell);
      float grid = 1.0 - min(min(from.x, from.y), 1.0);
      float fade = 1.0 - smoothstep(0.25, 1.0, distance(at.xz, center.xz) / radius);
      gl_FragColor = vec4(mix(color, line, grid * 0.55 * fade), fade * (gl_FrontFacing ? 1.0 : 0.5));
    }`,
  extensions: {derivatives: true},
});

// Whether pictures are computed without a graphics card; `?quality=high` or `low` in the address comes first.
function isPlain() {
  const quality = new URLSearchParams(location.search).get('quality');
  if (quality) return quality === 'low';
  const probe = document.createElement('canvas').getContext('webgl'), about = probe && probe.getExtension('WEBGL_debug_renderer_info');
  const name = about ? probe.getParameter(about.UNMASKED_RENDERER_WEBGL) : '';
  if (probe) probe.getExtension('WEBGL_lose_context').loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

function makeRenderer(canvas, plain) {
  const options = {alpha: false, antialias: !plain, powerPreference: 'high-performance'};
  const context = canvas.getContext('webgl2', options) || canvas.getContext('webgl', options);
  if (!context) throw new Error('This browser has no WebGL. The page shows the numbers, but it cannot draw the picture.');
  const renderer = new THREE.WebGLRenderer({canvas, context});
  renderer.gammaOutput = true;
  renderer.gammaFactor = 2.2;
  renderer.shadowMap.enabled = !plain;
  return renderer;
}

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    const plain = isPlain();
    this.renderer = makeRenderer(canvas, plain);
    this.scene = new THREE.Scene();
    this.orbit = new Orbit(canvas, () => this.invalidate());
    this.camera = this.orbit.camera;
    this.beforeRender = [];
    this.beforeDraw = [];  // each is given the time, s, and dt; it returns true to be drawn again
    this.pixels = 1;       // share of the screen's own
    this.slowSince = null; // when pictures began to come late, s
    this.pictures = 0;
    this.isStale = false;
    this.addBackdrop();
    this.addTable();
    this.addLight(plain);
    this.paint();
    onThemeChange(() => this.paint());
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  addBackdrop() {
    this.backdrop = new THREE.Mesh(new THREE.PlaneBufferGeometry(2, 2), new THREE.ShaderMaterial(BACKDROP));
    this.backdrop.frustumCulled = false;
    this.backdrop.renderOrder = -1000;
    this.scene.add(this.backdrop);
  }

  addLight(plain) {
    this.hemisphere = new THREE.HemisphereLight();
    this.sun = new THREE.DirectionalLight();
    this.fill = new THREE.DirectionalLight();
    this.sunWay = new THREE.Vector3(-0.45, 1, 0.5).normalize();
    this.fill.position.set(0.8, 0.25, -0.6);
    this.sun.castShadow = !plain;
    this.sun.shadow.mapSize.set(1024, 1024);
    this.sun.shadow.radius = 2.5;
    this.sun.shadow.bias = -0.002;
    Object.assign(this.sun.shadow.camera, {left: -0.2, right: 0.2, top: 0.2, bottom: -0.2, near: 0.1, far: 1.6});
    this.scene.add(this.hemisphere, this.sun, this.sun.target, this.fill);
    this.lightAt(new THREE.Vector3());
  }

  // The shadow's sharpness is spent where the hand is.
  lightAt(point) {
    this.sun.target.position.copy(point);
    this.sun.position.copy(point).addScaledVector(this.sunWay, 0.7);
    this.shade.visible = this.sun.castShadow;
    const down = point.y - this.table.position.y;
    this.shade.position.copy(point).addScaledVector(this.sunWay, -down / this.sunWay.y);
    this.shade.position.y += 2e-4;
  }

  addTable() {
    this.tables = [];
    this.table = this.addDisc(TABLE_RADIUS);
    this.shade = new THREE.Mesh(new THREE.CircleBufferGeometry(SHADOW_REACH, 32).rotateX(-Math.PI / 2), new THREE.ShadowMaterial({transparent: true, depthWrite: false}));
    this.shade.receiveShadow = true;
    this.shade.renderOrder = -890;
    this.scene.add(this.shade);
  }

  addDisc(radius) {
    const disc = new THREE.Mesh(new THREE.CircleBufferGeometry(radius, 72).rotateX(-Math.PI / 2), tableMaterial(radius));
    this.tables.push(disc);
    this.scene.add(disc);
    return disc;
  }

  setTable(center, height, disc = this.table) {
    disc.position.set(center[0], height, center[2]);
    disc.material.uniforms.center.value.copy(disc.position);
  }

  // What stands higher than the table stands on a small one of its own.
  setShelves(shelves) {
    for (const disc of this.tables.splice(1)) this.scene.remove(disc);
    for (const {place, height, radius} of shelves) this.setTable(place, height, this.addDisc(radius));
    this.paint();
  }

  paint() {
    const colors = sceneColors();
    const linear = (color, name) => color.set(name).convertGammaToLinear(2.2);
    this.backdrop.material.uniforms.sky.value.set(colors.sky);
    this.backdrop.material.uniforms.horizon.value.set(colors.horizon);
    for (const {material} of this.tables) {
      material.uniforms.color.value.set(colors.table);
      material.uniforms.line.value.set(colors.line);
    }
    this.shade.material.opacity = colors.shadow;
    linear(this.hemisphere.color, colors.hemisphereSky);
    linear(this.hemisphere.groundColor, colors.hemisphereGround);
    this.hemisphere.intensity = colors.hemisphere;
    linear(this.sun.color, colors.sun);
    this.sun.intensity = colors.sunPower;
    linear(this.fill.color, colors.fill);
    this.fill.intensity = colors.fillPower;
    this.invalidate();
  }

  resize(pixels = this.pixels) {
    const {clientWidth, clientHeight} = this.canvas.parentElement;
    if (!clientWidth || !clientHeight) return;
    this.drawn = pixels;
    this.orbit.room = this.covered();
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio) * pixels);
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.orbit.resize(clientWidth, clientHeight);
    if (this.pictures) this.render();  // a new size is an empty canvas
    else this.invalidate();
  }

  // What the tools leave free.
  covered() {
    const box = this.canvas.getBoundingClientRect(), tools = document.getElementById('tools').getBoundingClientRect();
    return {above: Math.max(0, tools.bottom - box.top), below: 0};
  }

  render() {
    for (const prepare of this.beforeRender) prepare();
    // first what all else stands on; from below last, before it all
    for (const disc of this.tables) disc.renderOrder = this.camera.position.y > disc.position.y ? -900 : 9000;
    this.renderer.render(this.scene, this.camera);
  }

  invalidate() {
    if (this.isStale) return;
    this.isStale = true;
    this.asked = performance.now() / 1000;
    requestAnimationFrame((now) => this.draw(now / 1000));
  }

  draw(now) {
    this.isStale = false;
    const dt = Math.min(0.1, this.last ? now - this.last : 0.016);
    this.last = now;
    let goesOn = this.orbit.step(dt);
    for (const prepare of this.beforeDraw) goesOn = prepare(now, dt) || goesOn;
    if (this.drawn !== this.pixels) this.resize();
    else this.render();
    this.pictures += 1;
    this.watch();
    clearTimeout(this.rest);
    if (goesOn) this.invalidate();
    else if (this.pixels < 1) this.rest = setTimeout(() => this.resize(1), REST);  // a still picture may take its time
  }

  // Where pictures come late, fewer pixels, down to half of them each way; never more again, so that the picture does not jump.
  watch() {
    const now = performance.now() / 1000;
    if (now - this.asked < SLOW) this.slowSince = null;
    else this.slowSince = this.slowSince || now;
    if (!this.slowSince || now - this.slowSince < PATIENCE || this.pixels <= 0.5) return;
    this.slowSince = now;
    this.pixels = Math.max(0.5, this.pixels * 0.75);
  }
}
