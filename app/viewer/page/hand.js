// SPDX-License-Identifier: MIT
// The hand as it is drawn: skin, shadow, and the ghost of the rigged hand.
import * as THREE from './three.module.js';
import {ARM_LITTLE, ARM_THUMB, BALLS, flats, HAND_SHADER, handGeometry, JOINTS, WEB, WEBS, WRIST_LITTLE, WRIST_THUMB} from './hand_shape.js';
import {GLASS_SAMPLES} from './profile.js';
import {onThemeChange, sceneColors} from './theme.js';

const LEAST_RADIUS = 0.003;  // m: the paper's bare points have none, and would not be seen
const PALM = flats();
const FINGER_BASES = [4, 9, 14, 19];
const WEB_SHARE = 0.62;      // of the index finger's metacarpal, from its base, up to where the web of the thumb reaches
const FORK = 0.15;            // of a finger's first phalanx, up to where the skin between two fingers reaches
const WRIST_HALF = 0.0145, WRIST_RADIUS = 0.0115, ARM_HALF = 0.017, ARM_RADIUS = 0.0145, ARM_LENGTH = 0.085;  // m, of an adult's hand

const DECLARATIONS = `#define GLASS_SAMPLES ${GLASS_SAMPLES}\n${HAND_SHADER}`;
const FADE = 'smoothstep(0.17, 0.98, arm)';

const UNDER_TABLE = 0.25;  // of what is under the table and seen from above

// Teaches one of three's materials where the vertices are, that the forearm fades, and that the table covers what is under it.
function taught(material, uniforms, isDepth) {
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    const place = 'vec3 hand_at, hand_normal; hand_place(hand_at, hand_normal);';
    shader.vertexShader = isDepth ?
      shader.vertexShader.replace('#include <common>', `#include <common>\n${DECLARATIONS}`).replace('#include <begin_vertex>',
        `${place} vec3 transformed = hand_at;`) :
      shader.vertexShader.replace('#include <common>', `#include <common>\n${DECLARATIONS} varying float height;`).replace('#include <beginnormal_vertex>',
        `${place} vec3 objectNormal = hand_normal; height = hand_at.y;`).replace('#include <begin_vertex>', 'vec3 transformed = hand_at;');
    shader.fragmentShader = shader.fragmentShader.replace('#include <common>', `#include <common>\nvarying float arm${isDepth ? '' : ', height; uniform float table'};`);
    if (isDepth) {
      shader.fragmentShader = shader.fragmentShader.replace('void main() {', `void main() { if (${FADE} > 0.6) discard;`);
    } else {
      shader.fragmentShader = shader.fragmentShader.replace('#include <fog_fragment>', `gl_FragColor.a *= (1.0 - ${FADE}) * (height < table && cameraPosition.y > table ? ${UNDER_TABLE} : 1.0);`);
      // light that has gone through flesh warms what the sun only grazes
      shader.fragmentShader = shader.fragmentShader.replace('#include <lights_fragment_end>', `#include <lights_fragment_end>
        float graze = 1.0 - saturate(dot(normal, normalize(vViewPosition)));
        reflectedLight.indirectDiffuse += diffuseColor.rgb * vec3(0.30, 0.10, 0.06) * (0.25 + 0.75 * graze * graze);`);
    }
  };
  return material;
}

const GHOST_FRAGMENT = `
  uniform vec3 color; uniform float body; varying vec3 out_of, to_eye; varying float arm;
  void main() {
    float graze = 1.0 - abs(dot(normalize(out_of), normalize(to_eye)));
    gl_FragColor = vec4(color, (body + 0.65 * graze * graze) * (1.0 - ${FADE}));
  }`;
const GHOST_VERTEX = `${DECLARATIONS} varying vec3 out_of, to_eye;
  void main() {
    vec3 hand_at, hand_normal; hand_place(hand_at, hand_normal);
    vec4 view = viewMatrix * vec4(hand_at, 1.0);
    out_of = mat3(viewMatrix) * hand_normal; to_eye = -view.xyz;
    gl_Position = projectionMatrix * view;
  }`;

class Skin {
  constructor(geometry) {
    this.uniforms = {
      ball: {value: Array.from({length: BALLS}, () => new THREE.Vector4())},
      skin: {value: Array.from({length: BALLS}, () => new THREE.Vector3())},
      to_glass: {value: new THREE.Matrix4()}, from_glass: {value: new THREE.Matrix4()},
      glass: {value: new Float32Array(GLASS_SAMPLES)}, glass_height: {value: 0}, table: {value: 0},
    };
    this.mesh = new THREE.Mesh(geometry);
    this.mesh.frustumCulled = false;
  }

  // `joints`: 24 places in the world, `wrist` that of the wrist; `radii` of the joints, m.
  pose(joints, wrist, radii, size) {
    const ball = this.uniforms.ball.value;
    const at = (k) => new THREE.Vector3(...joints[k]);
    for (let k = 0; k < JOINTS; ++k) ball[k].set(...joints[k], Math.max(LEAST_RADIUS * size, radii[k] * size));
    const aside = at(FINGER_BASES[3]).sub(at(FINGER_BASES[0])).normalize();
    const bases = FINGER_BASES.reduce((sum, k) => sum.addScaledVector(at(k), 0.25), new THREE.Vector3());
    const middle = new THREE.Vector3(...wrist);
    const back = middle.clone().sub(bases);
    back.addScaledVector(aside, -back.dot(aside)).normalize();
    const set = (k, place, radius) => ball[k].set(place.x, place.y, place.z, radius * size);
    set(WRIST_THUMB, middle.clone().addScaledVector(aside, -WRIST_HALF * size), WRIST_RADIUS);
    set(WRIST_LITTLE, middle.clone().addScaledVector(aside, WRIST_HALF * size), WRIST_RADIUS);
    middle.addScaledVector(back, ARM_LENGTH * size);
    set(ARM_THUMB, middle.clone().addScaledVector(aside, -ARM_HALF * size), ARM_RADIUS);
    set(ARM_LITTLE, middle.clone().addScaledVector(aside, ARM_HALF * size), ARM_RADIUS);
    ball[WEB].copy(ball[FINGER_BASES[0]]).lerp(ball[FINGER_BASES[0] + 1], WEB_SHARE);
    ball[WEB].w *= 0.8;
    for (let f = 0; f < 3; ++f) {
      const [a, b] = [FINGER_BASES[f] + 1, FINGER_BASES[f + 1] + 1];
      ball[WEBS + f].copy(ball[a]).lerp(ball[a + 1], FORK).add(ball[b].clone().lerp(ball[b + 1], FORK)).multiplyScalar(0.5);
      ball[WEBS + f].w *= 0.9;
    }
    this.smooth();
  }

  // One normal where pieces of the palm meet, so that no crease is seen.
  smooth() {
    const ball = this.uniforms.ball.value, skin = this.uniforms.skin.value;
    for (const way of skin) way.set(0, 0, 0);
    const [a, ab, ac] = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()];
    for (const corners of PALM) {
      a.copy(ball[corners[0]]);
      ab.copy(ball[corners[1]]).sub(a);
      ac.copy(ball[corners[2]]).sub(a);
      ab.cross(ac);
      for (const corner of corners) skin[corner].add(ab);
    }
    // at the wrist, that of the forearm
    const along = ab.copy(ball[ARM_THUMB]).sub(ball[WRIST_THUMB]), up = a.copy(ball[WRIST_LITTLE]).sub(ball[WRIST_THUMB]).cross(along);
    if (up.dot(skin[WRIST_THUMB]) < 0) up.negate();
    for (const k of [WRIST_THUMB, WRIST_LITTLE]) skin[k].copy(up);
    for (const way of skin) way.normalize();
  }

  // The vessel whose glass flattens the flesh, or null. `matrix`: vessel to world.
  press(matrix, profile) {
    this.uniforms.glass_height.value = profile ? profile.height : 0;
    if (!profile) return;
    this.uniforms.glass.value = profile.samples;
    this.uniforms.from_glass.value.copy(matrix);
    this.uniforms.to_glass.value.getInverse(matrix);
  }
}

// `body`: how much of it is seen where it is not its rim.
function makeGhost(skin, body) {
  skin.mesh.material = new THREE.ShaderMaterial({
    vertexShader: GHOST_VERTEX, fragmentShader: GHOST_FRAGMENT, transparent: true, polygonOffset: true, polygonOffsetFactor: 2,
    polygonOffsetUnits: 8,  // where both are in one place the skin is seen
    uniforms: {...skin.uniforms, color: {value: new THREE.Color()}, body: {value: body}},
  });
  skin.mesh.renderOrder = 500;
  skin.mesh.visible = false;
}

export class Hand {
  constructor(scene, joints) {
    this.radii = joints.map((joint) => joint.radius);
    const geometry = handGeometry(joints.map((joint) => joint.parent));
    this.skin = new Skin(geometry);
    this.ghost = new Skin(geometry);
    const {mesh} = this.skin;
    mesh.material = taught(new THREE.MeshStandardMaterial({roughness: 0.62, metalness: 0, transparent: true}), this.skin.uniforms, false);
    mesh.renderOrder = -10;
    mesh.customDepthMaterial = taught(new THREE.MeshDepthMaterial({depthPacking: THREE.RGBADepthPacking}), this.skin.uniforms, true);
    mesh.castShadow = mesh.receiveShadow = true;
    this.advised = new Skin(geometry);  // the hand of the grip that would be better
    makeGhost(this.ghost, 0.07);
    makeGhost(this.advised, 0.22);
    scene.add(mesh, this.ghost.mesh, this.advised.mesh);
    this.paint();
    onThemeChange(() => this.paint());
  }

  paint() {
    const colors = sceneColors();
    this.skin.mesh.material.color.set(colors.skin).convertGammaToLinear(2.2);
    this.ghost.mesh.material.uniforms.color.value.set(colors.ghost);
    this.advised.mesh.material.uniforms.color.value.set(colors.advised);
  }

  pose(frame, size) {
    this.skin.pose(frame.joints, frame.wrist, this.radii, size);
    if (this.ghost.mesh.visible) this.ghost.pose(frame.rigged, frame.rigged_wrist, this.radii, size);
    const {advice} = frame;
    this.advised.mesh.visible = Boolean(advice && advice.joints);
    if (this.advised.mesh.visible) this.advised.pose(advice.joints, advice.wrist, this.radii, size);
  }
}
