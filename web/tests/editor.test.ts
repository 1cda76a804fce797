import { describe, expect, it } from "vitest";
import { formatModelHash, parseModelHash } from "../src/editor/link";
import { Orders } from "../src/editor/orders";
import { parameters, written } from "../src/editor/parameters";

describe("parameters of a text", () => {
  const one = (line: string) => parameters(`\n${line}\naxiom: A\n`)[0];

  it("are its numbers with a name, and know where they stand", () => {
    const text = "#define A 1\n#define f(x) 2*x\n#define NAME A\n  # define  rate -.5e1\r\n#define END 2";
    const found = parameters(text);
    expect(found.map(({ name, value }) => [name, value])).toEqual([
      ["A", 1],
      ["rate", -5],
      ["END", 2],
    ]);
    expect(found.map(({ from, to }) => text.slice(from, to))).toEqual(["1", "-.5e1", "2"]);
  });

  it("take range, unit and meaning from a comment in any of its forms", () => {
    const range = { low: 0.05, high: 0.3, unit: "m", meaning: "length of a leaf", declared: true };
    expect(one("#define LEAF 0.2 /* parameter: 0.05 to 0.3, m, length of a leaf */")).toMatchObject(range);
    expect(one("#define LEAF 0.2 /* parameter: 0.05 to 0.3 m, length of a leaf */")).toMatchObject(range);
    expect(one("#define LEAF 0.2 // length of a leaf, 0.05 to 0.3 m")).toMatchObject(range);
    const leaves = { low: 3, high: 16, unit: "", meaning: "leaves of the stem" };
    expect(one("#define LEAVES 9 /* parameter: 3 to 16, leaves of the stem */")).toMatchObject(leaves);
  });

  it("have a guessed range without a comment, and one that holds their value", () => {
    expect(one("#define A 3")).toMatchObject({ low: 0, high: 6, declared: false });
    expect(one("#define A -3")).toMatchObject({ low: -6, high: 0 });
    expect(one("#define A 0")).toMatchObject({ low: -1, high: 1 });
    expect(one("#define A 9 /* 1 to 4 */")).toMatchObject({ low: 1, high: 9 });
  });

  it("are written as short as their range allows", () => {
    expect(written(7.3, one("#define A 4 /* 1 to 9 */"))).toBe("7");
    expect(written(0.123456, one("#define A 0.2 /* 0 to 1 */"))).toBe("0.123");
    expect(written(0.00123456, one("#define A 0.002 /* 0 to 0.01 */"))).toBe("0.00123");
    expect(written(123.456789, one("#define A 100.5 /* 0 to 300 */"))).toBe("123.5");
  });
});

describe("links to a text", () => {
  it("come back as they went", async () => {
    const text = "/* Ä fern 🌿 */\naxiom: A(1)\nA(n) --> F[+A(n+1)]A(n+1)\n".repeat(40);
    for (const steps of [null, 0, 12]) {
      const hash = await formatModelHash({ text, seed: 41, steps });
      expect(hash.length).toBeLessThan(400);
      expect(hash).toMatch(/^#[\w=&-]+$/);
      expect(await parseModelHash(hash)).toEqual({ text, seed: 41, steps });
    }
  });

  it("that are broken, or unfold without end, restore nothing", async () => {
    const hash = await formatModelHash({ text: "axiom: A", seed: 1, steps: null });
    for (const broken of [
      "",
      "#model=",
      "#seed=1",
      "#model=%%%",
      `${hash.slice(0, -3)}`,
      hash.replace("=1", "=x"),
    ]) {
      expect(await parseModelHash(broken)).toBeNull();
    }
    const bomb = new Blob([new Uint8Array(4_000_000)])
      .stream()
      .pipeThrough(new CompressionStream("deflate-raw"));
    const bytes = Buffer.from(await new Response(bomb).arrayBuffer());
    expect(await parseModelHash(`#model=${bytes.toString("base64url")}`)).toBeNull();
  });
});

describe("orders", () => {
  const order = (text: string) => ({ text, steps: null, seed: 1, homomorphism: false, environment: null });

  it("go one at a time, the newest next, none twice", () => {
    const sent: [number, string][] = [];
    const orders = new Orders((number, { text }) => sent.push([number, text]));
    for (const text of ["a", "a", "b", "c"]) orders.ask(order(text));
    expect(sent).toEqual([[1, "a"]]);
    expect(orders.take(1)).toBe(true);
    expect(sent).toEqual([
      [1, "a"],
      [2, "c"],
    ]);
    expect(orders.take(1)).toBe(false);
    expect(orders.busy).toBe(true);
    expect(orders.take(2)).toBe(true);
    expect(orders.busy).toBe(false);
  });
});
