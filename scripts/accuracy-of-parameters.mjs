// Writes docs/accuracy-of-parameters.md from what tests/measurement/texture recorded (one JSON object a line).
//   node accuracy-of-parameters.mjs ROWS PAGE.md
import { readFileSync, writeFileSync } from "node:fs";

const [rowsFile, pageFile] = process.argv.slice(2);
const records = readFileSync(rowsFile, "utf8").trim().split("\n").map((line) => JSON.parse(line));
const rows = records.filter((record) => record.surface !== undefined);
const draws = records.filter((record) => record.draws !== undefined);

const cell = (text) => String(text).replaceAll("|", "\\|");
const number = (value, digits = 7) => {
  if (typeof value !== "number") return cell(value);
  const size = Math.abs(value);
  if (value === 0 || size < 1e-12) return "0";
  return size < 1e-4 ? value.toExponential(2).replace("e-", "e−") : String(Number(value.toPrecision(digits))).replace("-", "−");
};
const figures = (row) => (row.expected === "∞" ? "" : row.figures >= 9 ? "9+" : row.figures.toFixed(1));
const order = (row) => (row.order === undefined ? "" : row.order.toFixed(2).replace("-", "−"));

// One column a parameter, for those that many surfaces have; the short word for what was reached.
const columns = ["Sa", "Sq", "Sz", "Ssk", "Sku", "Sdq", "Sdr", "Sk", "Vmp", "Vmc", "Vvc", "Vvv", "Sxp", "Sal", "Str"];
const surfaces = [...new Set(rows.map((row) => row.surface))];
const short = (row) => {
  if (!row) return "";
  if (row.expected === "∞") return `h^${order(row)}`;
  if (row.figures >= 6) return row.figures >= 9 ? "9+" : row.figures.toFixed(0);
  return row.order === undefined ? row.figures.toFixed(1) : `${row.figures.toFixed(1)} (h^${Math.round(row.order)})`;
};
const overview = [
  `| surface | ${columns.join(" | ")} |`,
  `|---|${columns.map(() => "---").join("|")}|`,
  ...surfaces.filter((surface) => rows.some((row) => row.surface === surface && row.parameter.startsWith("S")))
    .map((surface) => `| ${cell(surface)} | ${columns.map((name) =>
      short(rows.find((row) => row.surface === surface && row.parameter === name))).join(" | ")} |`),
].join("\n");

const details = surfaces.map((surface) => {
  const here = rows.filter((row) => row.surface === surface);
  const lines = here.map((row) => `| ${cell(row.parameter)} | ${number(row.expected)} | ${number(row.found)} | ${figures(row)} | ${order(row)} | ${row.figures < 6 ? cell(row.why) : ""} |`);
  return `### ${surface[0].toUpperCase()}${surface.slice(1)}\n\n\`${here[0].formula}\`\n\n| parameter | closed form | found | figures | order | why not more |\n|---|---|---|---|---|---|\n${lines.join("\n")}\n`;
}).join("\n");

const random = draws.map((row) => {
  const known = row.expected !== undefined;
  const off = known ? ((row.found - row.expected) / row.error).toFixed(1).replace("-", "−") : "";
  return `| ${cell(row.parameter)} | ${known ? number(row.expected, 5) : ""} | ${number(row.found, 5)} ± ${number(row.error, 2)} | ${off} | ${row.stated === undefined ? "" : row.stated.toFixed(2)} | ${cell(row.why)} |`;
}).join("\n");

writeFileSync(pageFile, `# How accurate the surface parameters are

Surfaces that are defined by a formula have parameters in closed form (the idea of Todhunter, Leach and Lawes, *Mathematical approach to the validation of functional surface texture parameter software*, Surf. Topogr. 8 (2020)). [\`tests/measurement/texture\`](../tests/measurement/texture) samples such surfaces, compares what the program finds with the closed forms, and asserts figures and orders; CI runs it. \`scripts/accuracy-of-parameters.sh\` measures anew and writes this page.

*Figures* are significant figures that agree, −log₁₀ of the relative error, with 256 × 256 samples (waves along x: 256 a wave) unless said; heights are stored in 24 bits, which is 7 figures of a single height. *Order* is that of the error in the spacing h, from two halvings: an error of h² is a quarter at half the spacing, and an order that comes out whole means that the limit is right to far more figures than the value shows.

${overview}

## What to know

- **Sz** is the range of the *samples*, as ISO 25178-2 defines it for sampled data. The crest between two samples is higher: Sz is a bound from below for the surface, off by h² at a smooth crest and by h at an edge. It has no standard error.
- **Sdq and Sdr** are those of the facets that light meets (two triangles a cell), whose slopes are those of chords: h² too small on smooth surfaces, h where there are kinks. That is on purpose: the same slopes go into the BSDF. Across an upright wall Sdq grows as h^−½ without limit, and Sdr converges to the area of the wall.
- **Sa** has a kink where the surface crosses its mean: h², and a phase that hangs on where samples lie. Askew to the samples it is far better, since they then meet all heights evenly.
- **Patches**: n samples have n − 1 cells, so half a cell at each end has no slope, and an error of h is left in Sdq and Sdr where the slope there is not the mean one.
- **Material ratio curve**: with even shares of heights, six figures and more. A relief that is aligned with its samples has rows of equal heights; the curve is then a staircase, and volumes are off by h. Sk is the line of least squares through the flattest 40 %. Where the curve is not S-shaped the flattest stretch lies at an end (for a sine at either: Smr1, Smr2, Spk and Svk then mean nothing).
- **Sal and Str**: between lags by polynomials of the fifth degree, between directions by golden sections. On a random surface Sal is the shortest of many noisy directions and so too small by some per cent: that is the definition's, not the estimator's.
- **Profile slopes** use the seven-point derivative of ISO 4287, of order 6, without three samples at each end.

## Defined surfaces and profiles

${details}
## Random surfaces

Periodic Gaussian surfaces with the autocorrelation exp(−r²/τ²), τ = 5 samples, ${draws[0]?.draws ?? 0} draws of 128 × 128 samples of 1 µm, standard deviation 1 µm. *Off* counts in standard errors of the mean. *Stated* is the root mean square of the standard errors that the program states, divided by the scatter of the draws: 1 is honest (± 0.1, since the scatter is known that well).

| parameter | expected | mean of the draws | off | stated | |
|---|---|---|---|---|---|
${random}

Besides: the radial spectrum against π τ² exp(−π² τ² f²) and the slope distribution against the Gaussian of the facets' chords, by χ².
`);
