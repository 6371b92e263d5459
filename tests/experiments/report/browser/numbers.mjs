// Numbers as the page writes them: the standard error decides the digits.
import assert from 'node:assert/strict';
import { estimate, plain, quantityText } from '../../../../experiments/report/page/lib/number.js';

const spaced = (text) => text.replace(/[\u00a0\u202f\u2009]/g, ' ');

const ESTIMATES = [
  [0.25031, 0.00123, '0.2503 ± 0.0012'],
  [0.5, 0.0996, '0.50 ± 0.10'],       // the error carries into a new digit
  [12342, 120, '12 340 ± 120'],
  [-3.14159, 0.25, '−3.14 ± 0.25'],
  [1.234e-5, 1.2e-7, '(1.234 ± 0.012) × 10⁻⁵'],
  [0, 0.0021, '0.0000 ± 0.0021'],
  [2.5e7, 1.5e6, '(2.50 ± 0.15) × 10⁷'],
  [null, 0.1, '—'],
  [0.25, null, '0.25'],
];
const PLAIN = [[1234567, '1 234 567'], [-0.25, '−0.25'], [0.1 + 0.2, '0.3'], [1e-5, '1 × 10⁻⁵'], [NaN, '—'], [0, '0']];

export function checkNumbers() {
  for (const [value, error, text] of ESTIMATES) assert.equal(spaced(estimate(value, error)), text);
  for (const [value, text] of PLAIN) assert.equal(spaced(plain(value)), text);
  assert.equal(spaced(quantityText({ value: 0.25031, unit: 'um', standard_error: 0.00123 })), '0.2503 ± 0.0012 µm');
  assert.equal(spaced(quantityText({ value: 30, unit: 'deg' })), '30°');
  console.log('passed: numbers');
}
