// SPDX-License-Identifier: BSD-3-Clause
// A flight: the module's point vehicle, moved on in the time of the page.

const LONGEST = 0.1; // that one frame may move on: a slow browser flies slower, not in jumps [s]

const at = (id) => document.getElementById(id);

export class Flight {
  /** Takes the playground's scene, and is its flight from then on. @throws Error with the module's sentence. */
  constructor(playground, speed) {
    Object.assign(this, { playground, speed, playing: false, events: [], answer: null });
    const state = playground.ask({ do: "fly", scene: playground.scene });
    playground.flight = this;
    this.take(state);
  }

  get over() {
    return this.state.outcome !== null;
  }

  play(on) {
    this.playing = on && !this.over;
    this.before = undefined;
    if (!on) this.explain();
    this.playground.showPlaying();
    this.playground.redraw();
  }

  advance(now) {
    if (this.before !== undefined) this.step(this.speed * Math.min((now - this.before) / 1000, LONGEST));
    this.before = now;
  }

  step(seconds) {
    if (!this.over) this.take(this.playground.ask({ do: "step", seconds }));
  }

  /** Walls and pillars as they stand in the scene now. */
  move() {
    if (!this.over) this.take(this.playground.ask({ do: "move", scene: this.playground.scene }));
  }

  take(state) {
    const { panel, picture } = this.playground;
    this.state = state;
    this.events.push(...state.events);
    if (state.plan) this.answer = state.plan;
    picture.seen.change(state.map);
    picture.addTrail(state.p, state.pad.p);
    if (state.plan) panel.show(state.plan, this.playground.scene, null);
    panel.flight(this);
    at("time").textContent = `${state.t.toFixed(1)} s`;
    if (!this.over) return;
    this.events.push({ t: state.t, text: state.outcome.sentence });
    panel.flight(this);
    this.play(false);
    this.playground.showOutcome();
  }

  /** The newest step once more, with its attempts. */
  explain() {
    if (!this.answer) return;
    this.answer = this.playground.ask({ do: "why" }) ?? this.answer;
    this.playground.panel.show(this.answer, this.playground.scene, this.playground.attempt);
    this.playground.redraw();
  }

  /** Puts vehicle and pad where they are. */
  place() {
    const { picture } = this.playground, { p, q, pad, belief } = this.state;
    picture.setCraft(p, q);
    picture.deck.set(pad.p, pad.yaw);
    picture.deck.believe(belief);
  }

  /** So many metres in front of the vehicle, in the direction in which it flies. */
  ahead(metres) {
    const { p, v } = this.state, speed = Math.hypot(v[0], v[1]);
    const [x, y] = speed > 0.1 ? [v[0] / speed, v[1] / speed] : [1, 0];
    return { x: p[0] + metres * x, y: p[1] + metres * y, yaw: Math.round((Math.atan2(y, x) * 180) / Math.PI) };
  }
}
