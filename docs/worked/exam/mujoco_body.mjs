// MuJoCo's flexible bodies, which sit the exam of soft bodies at the pipe: Saint Venant-Kirchhoff
// elements with every vertex a body on three slides, in small explicit steps. Where the tool leads,
// the vertices are so heavy that nothing but their own velocity moves them.
//
//     npm install mujoco@3.1.16
//     haptrial exam run out/exam-soft --out out/answers-mujoco --program node docs/worked/exam/mujoco_body.mjs node_modules/mujoco
import { readFileSync } from 'node:fs';
import { createInterface } from 'node:readline';
import { pathToFileURL } from 'node:url';

const kLed = 1e9;       // mass of a vertex that the tool holds [kg]
const kCourant = 0.4;   // of the time in which a wave goes through the thinnest element: a step
const kStrain = 0.2;    // damping of the elements, in steps
const kBrake = 20;      // of every vertex of a body that is fixed somewhere, by its mass [1/s]

const numbers = (line) => line.trim().split(/\s+/).map(Number);

/** A body's files: places, forces at a load of 1, markers; elements by their material. */
function readBody(nodeFile) {
  const rows = (file) =>
    readFileSync(file, 'utf8').split('\n').filter((line) => line.trim()).slice(1).map(numbers);
  const vertices = rows(nodeFile).map(([, x, y, z, fx, fy, fz, marker]) =>
    ({ place: [x, y, z], force: [fx, fy, fz], marker, mass: 0 }));
  const materials = new Map();
  let step = 1e-3;
  for (const [, a, b, c, d, young, poisson, density] of rows(nodeFile.replace(/node$/, 'ele'))) {
    const corners = [a, b, c, d];
    const { volume, thickness } = sizes(corners.map((i) => vertices[i].place));
    corners.forEach((i) => { vertices[i].mass += density * volume / 4; });
    const wave = Math.sqrt(young * (1 - poisson) / (1 + poisson) / (1 - 2 * poisson) / density);
    step = Math.min(step, kCourant * thickness / wave);
    const name = `${young} ${poisson}`;
    materials.set(name, [...(materials.get(name) ?? []), corners]);
  }
  return { vertices, materials, step };
}

/** Volume of a tetrahedron and its least height. */
function sizes([o, ...corners]) {
  const [a, b, c] = corners.map((p) => p.map((x, i) => x - o[i]));
  const cross = (u, v) =>
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  const minus = (u, v) => u.map((x, i) => x - v[i]);
  const faces = [cross(a, b), cross(b, c), cross(c, a), cross(minus(b, a), minus(c, a))];
  const six = Math.abs(faces[1].reduce((sum, x, i) => sum + x * a[i], 0));
  return { volume: six / 6, thickness: six / Math.max(...faces.map((n) => Math.hypot(...n))) };
}

/** Young's modulus and Poisson's ratio for elements that count Lame's first constant twice, as those
 * of this package do: half of it, and the same shear modulus. */
function asCounted(young, poisson) {
  const shear = young / 2 / (1 + poisson);
  const half = shear * poisson / (1 - 2 * poisson);
  const ratio = half / 2 / (half + shear);
  return { young: 2 * shear * (1 + ratio), poisson: ratio };
}

function modelOf({ vertices, materials, step }) {
  const brake = vertices.some(({ marker }) => marker === 1) ? kBrake : 0;
  const joints = (mass) => ['1 0 0', '0 1 0', '0 0 1']
    .map((axis) => `<joint type="slide" axis="${axis}" damping="${brake * mass}"/>`).join('');
  const body = ({ place, marker, mass }, i) =>
    `<body name="v${i}" pos="${place.join(' ')}"><inertial pos="0 0 0" diaginertia="1 1 1" ` +
    `mass="${marker === 2 ? kLed : mass}"/>${marker === 1 ? '' : joints(marker === 2 ? 0 : mass)}</body>`;
  const flex = ([material, elements], i) => {
    const used = [...new Set(elements.flat())];
    const number = new Map(used.map((vertex, at) => [vertex, at]));
    const { young, poisson } = asCounted(...numbers(material));
    return `<flex name="f${i}" dim="3" body="${used.map((v) => `v${v}`).join(' ')}" ` +
      `element="${elements.flat().map((v) => number.get(v)).join(' ')}">` +
      '<contact contype="0" conaffinity="0" selfcollide="none" internal="false"/>' +
      `<elasticity young="${young}" poisson="${poisson}" damping="${kStrain * step}"/></flex>`;
  };
  return '<mujoco><size memory="200M"/>' +
    `<option timestep="${step}" gravity="0 0 0" integrator="Euler"><flag constraint="disable"/></option>` +
    `<worldbody>${vertices.map(body).join('')}</worldbody>` +
    `<deformable>${[...materials].map(flex).join('')}</deformable></mujoco>`;
}

class SoftBody {
  constructor(mujoco, file, rate) {
    this.mujoco = mujoco;
    const body = readBody(file);
    this.steps = Math.ceil(1 / rate / body.step);
    body.step = 1 / rate / this.steps;
    this.period = 1 / rate;
    this.vertices = body.vertices;
    mujoco.FS.writeFile('/body.xml', modelOf(body));
    this.model = mujoco.MjModel.mj_loadXML('/body.xml');
    this.data = new mujoco.MjData(this.model);
    let at = 0;
    for (const vertex of this.vertices) {  // the first of a vertex's three coordinates
      vertex.at = vertex.marker === 1 ? -1 : at;
      at += vertex.marker === 1 ? 0 : 3;
    }
    this.led = this.vertices.filter((v) => v.marker === 2);
  }
  close() {
    this.data.delete();
    this.model.delete();
  }
  start() {
    this.mujoco.mj_resetData(this.model, this.data);
    this.tool = [0, 0, 0];
  }
  /** @param tool  how far the vertices that it holds are moved @returns the force on the tool */
  tick(tool, load) {
    const { qpos, qvel, qfrc_applied: applied } = this.data;
    for (const { at, marker, force } of this.vertices) {
      for (let i = 0; i < 3 && at >= 0; ++i) {
        applied[at + i] = load * force[i];
        if (marker === 2) {
          qpos[at + i] = this.tool[i];
          qvel[at + i] = (tool[i] - this.tool[i]) / this.period;
        }
      }
    }
    this.tool = tool;
    for (let i = 0; i < this.steps; ++i) {
      this.mujoco.mj_step(this.model, this.data);
    }
    this.mujoco.mj_fwdPosition(this.model, this.data);
    this.mujoco.mj_fwdVelocity(this.model, this.data);
    const passive = this.data.qfrc_passive;
    return [0, 1, 2].map((i) => this.led.reduce((sum, { at }) => sum + passive[at + i], 0));
  }
  shape() {
    const { qpos } = this.data;
    return this.vertices.flatMap(({ at }) => at < 0 ? [0, 0, 0] : [qpos[at], qpos[at + 1], qpos[at + 2]]);
  }
}

if (process.argv.length !== 3) {
  console.error('usage: node mujoco_body.mjs FOLDER-OF-THE-PACKAGE-MUJOCO');
  process.exit(2);
}
const { default: load } = await import(pathToFileURL(`${process.argv[2]}/mujoco.js`));
const mujoco = await load();
let body;
let first;
for await (const line of createInterface({ input: process.stdin })) {
  const [word, ...rest] = line.split(' ');
  if (word === 'body') {  // body soft rate HZ FILE
    body?.close();
    body = new SoftBody(mujoco, line.split(' ').slice(4).join(' '), Number(rest[2]));
    console.log('ready');
  } else if (word === 'start') {  // start X Y Z
    first = rest.map(Number);
    body.start();
    console.log('ready');
  } else if (word === 'tick') {  // tick TIME X Y Z LOAD
    const [, x, y, z, share] = rest.map(Number);
    console.log(body.tick([x, y, z].map((p, i) => p - first[i]), share).join(' '));
  } else {  // shape
    console.log(body.shape().join(' '));
  }
}
