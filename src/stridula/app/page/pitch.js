// The pitch of a sound from its spectrum: its lowest strong partial, since the partials of glasses are not harmonic, or
// the common fundamental of harmonic ones that is itself too faint.
const [LOWEST, HIGHEST] = [100, 4000]; // Ends of the pitch [Hz]; hum of the mains lies below.
const TOP = 8000; // Highest frequency of a partial [Hz].
const STRONG = 0.01; // Least power of a strong partial, relative to the strongest.
const CLEAR = 60; // Least power of a partial relative to the median around: noise reaches about ten.
const AROUND = 1.5; // Factor on a frequency that is around it, and
const FEWEST = 40; // least number of samples on each side.
const HARMONIC = 0.005; // Greatest distance of a partial from a harmonic, relative to it.
const BETWEEN = 3; // Least number of partials between the harmonics of the lowest that show a lower fundamental.
const MOST = 12; // Number of partials that decide.
const AGREED = 40; // Greatest distance between moments that agree [cents], and
const MOMENTS = 5; // their number.

// The pitch of a moment [Hz], null without one; power is that of a sound under a Hann window.
export function pitchOf(power, rate) {
  const each = rate / (2 * power.length);
  const strong = partials(power, each);
  if (!strong.length || strong[0] > HIGHEST) return null;
  const [lowest] = strong;
  for (const share of [2, 3]) {
    const base = lowest / share;
    const isOf = (fundamental, one) => Math.abs(one / fundamental / Math.round(one / fundamental) - 1) < HARMONIC;
    const between = strong.filter((one) => !isOf(lowest, one));
    if (between.length >= BETWEEN && base >= LOWEST && strong.every((one) => isOf(base, one))) return base;
  }
  return lowest;
}

// Frequencies of the strong partials, rising.
function partials(power, each) {
  const [first, last] = [Math.ceil(LOWEST / each), Math.min(power.length - 1, Math.floor(TOP / each))];
  const least = STRONG * power.subarray(first, last).reduce((most, one) => Math.max(most, one), 0);
  const found = [];
  for (let k = first; k < last && found.length < MOST; k++) {
    const isStrong = power[k] > least && power[k] > power[k - 1] && power[k] >= power[k + 1];
    if (isStrong && power[k] > CLEAR * medianAround(power, k)) found.push(each * summit(power, k));
  }
  return found;
}

function medianAround(power, k) {
  const [low, high] = [Math.min(k / AROUND, k - FEWEST), Math.max(k * AROUND, k + FEWEST)].map(Math.round);
  const those = power.slice(Math.max(1, low), high).sort();
  return those[those.length >> 1];
}

// The place of a maximum between samples, by a parabola through the levels.
function summit(power, k) {
  const [before, here, after] = [power[k - 1], power[k], power[k + 1]].map((one) => Math.log(one + 1e-30));
  const bend = before - 2 * here + after;
  return k + (bend ? (0.5 * (before - after)) / bend : 0);
}

// A pitch on which the last moments agree.
export class Agreed {
  constructor() {
    this.last = [];
  }

  // The median of the last moments, null unless most of them have a pitch near it.
  after(frequency) {
    this.last = [...this.last, frequency].slice(-MOMENTS);
    const known = this.last.filter((one) => one !== null).sort((one, other) => one - other);
    const middle = known[Math.floor(known.length / 2)];
    const near = known.filter((one) => Math.abs(1200 * Math.log2(one / middle)) <= AGREED);
    return near.length > MOMENTS / 2 ? middle : null;
  }
}
