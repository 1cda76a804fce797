/** Colors that people with any kind of color vision can tell apart (after Okabe and Ito), on a dark ground. */
const PALETTE = ["#56b4e9", "#e69f00", "#2bb58a", "#f0e442", "#e5703a", "#cc79a7", "#5d8df0", "#c9c9c9"];

/** Words that keep one color everywhere and always; others get theirs by their letters. */
const KNOWN: Record<string, number> = {
  school: 0,
  align: 0,
  cohesion: 2,
  wander: 2,
  roam: 2,
  rest: 7,
  feed: 3,
  eat: 3,
  hunt: 4,
  chase: 4,
  flee: 4,
  avoid: 1,
  separation: 1,
  mate: 5,
  home: 6,
  born: 2,
  eaten: 4,
  startled: 1,
  died: 7,
};

/** The color of a behavior or kind of event: the same in chart, label and overlay. */
export function colorOf(word: string): string {
  return PALETTE[KNOWN[word.toLowerCase()] ?? hashed(word)];
}

/** The colors that species have got so far. */
const given = new Map<string, number>();

/**
 * The color of a species on every map. One whose letters lead to a color that another has got already
 * takes the next free one, as long as there are any.
 */
export function colorOfSpecies(species: string): string {
  let index = given.get(species);
  if (index === undefined) {
    const taken = new Set(given.values());
    const tries = PALETTE.map((_, step) => (hashed(species) + step) % PALETTE.length);
    index = tries.find((one) => !taken.has(one)) ?? tries[0];
    given.set(species, index);
  }
  return PALETTE[index];
}

function hashed(word: string): number {
  let sum = 7;
  for (const letter of word) sum = (sum * 31 + letter.charCodeAt(0)) % 9973;
  return sum % PALETTE.length;
}

/** Color number so many of a list of things that have no names. */
export function colorAt(index: number): string {
  return PALETTE[index % PALETTE.length];
}
