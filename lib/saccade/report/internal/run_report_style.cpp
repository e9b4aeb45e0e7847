// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/internal/run_report_style.hpp"

namespace saccade {

// Neither text holds < or &, so that the page stays well-formed XML.

std::string_view run_report_style() {
  return R"css(
:root { color-scheme: light dark;
  --page: #f5f6f8; --card: #ffffff; --ink: #1d232c; --soft: #5a6472; --line: #dfe3e9; --accent: #1f5fa8;
  --dim: none; --p0: #8a97a8; --p1: #2f6fb5; --p2: #c9862b; --p3: #4b9366; --p4: #8a68b0; --p5: #b5566a;
  --p6: #5fb3b8; --p7: #c4b44a; --p8: #6d5c4f; }
@media (prefers-color-scheme: dark) { :root {
  --page: #13161b; --card: #1b2027; --ink: #e3e8ee; --soft: #9ba6b4; --line: #2e3540; --accent: #7db2ec;
  --dim: brightness(0.86); --p0: #77859a; --p1: #5b9bdd; --p2: #d99c4a; --p3: #66b585; --p4: #a98ad0; --p5: #d17a8c;
  --p6: #74c6cb; --p7: #d6c765; --p8: #a08b7a; } }
* { box-sizing: border-box; }
html { scroll-padding-top: 3.6rem; -webkit-text-size-adjust: 100%; text-size-adjust: 100%; }
body { margin: 0; background: var(--page); color: var(--ink);
  font: 16px/1.5 system-ui, -apple-system, "Segoe UI", "Noto Sans", "DejaVu Sans", sans-serif;
  font-variant-numeric: tabular-nums; }
main, header, footer, nav ul { max-width: 72rem; margin: 0 auto; padding: 0 1.25rem; }
header { padding-top: 2rem; padding-bottom: 1rem; }
h1 { font-size: 1.75rem; line-height: 1.2; margin: 0 0 0.4rem; overflow-wrap: anywhere; }
h2 { font-size: 1.25rem; margin: 0; }
h3 { font-size: 1rem; margin: 1.4rem 0 0.5rem; }
p { margin: 0.3rem 0; }
a { color: var(--accent); text-underline-offset: 0.15em; }
.soft, figcaption, footer, .hint { color: var(--soft); }
.verdict { font-size: 1.08rem; max-width: 48rem; }
nav { position: sticky; top: 0; z-index: 2; background: var(--page); border-bottom: 1px solid var(--line); }
nav ul { display: flex; gap: 0.15rem; list-style: none; padding-top: 0.45rem; padding-bottom: 0.45rem;
  overflow-x: auto; scrollbar-width: thin; }
nav a { display: block; padding: 0.15rem 0.6rem; border-radius: 0.4rem; text-decoration: none; white-space: nowrap; }
nav a:hover, nav a[aria-current] { background: var(--line); }
a:focus-visible, img:focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; }
section { background: var(--card); border: 1px solid var(--line); border-radius: 0.7rem; padding: 1.1rem 1.25rem 1.25rem;
  margin: 1.25rem 0; }
.tiles { display: grid; grid-template-columns: repeat(auto-fill, minmax(8rem, 1fr)); gap: 1rem 1.1rem; margin: 0.9rem 0 0; }
.tiles div { border-top: 2px solid var(--line); padding-top: 0.5rem; }
.tiles dt { color: var(--soft); font-size: 0.875rem; }
.tiles dd { margin: 0; }
.tiles .big { font-size: 1.5rem; line-height: 1.3; font-weight: 600; }
.tiles .small { font-size: 0.8125rem; color: var(--soft); }
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 22rem), 1fr)); gap: 1.25rem 1.75rem;
  margin-top: 1.4rem; }
figure { margin: 0; min-width: 0; }
.charts figure { max-width: 38rem; }
figcaption { font-size: 0.875rem; margin-top: 0.35rem; }
.charts figcaption { color: var(--ink); font-size: 0.9375rem; font-weight: 600; margin: 0 0 0.3rem; }
.key { display: flex; flex-wrap: wrap; gap: 0.2rem 1rem; font-size: 0.8125rem; color: var(--soft); margin: 0.3rem 0 0;
  padding: 0; list-style: none; }
.swatch { display: inline-block; width: 0.75rem; height: 0.75rem; border-radius: 0.15rem; margin-right: 0.4rem;
  vertical-align: -0.08rem; border: 1px solid rgba(128, 128, 128, 0.35); print-color-adjust: exact;
  -webkit-print-color-adjust: exact; }
.swatch.wide { width: 2.6rem; }
.swatch.point { border-radius: 50%; }
.swatch.ring { background: transparent; border-width: 2px; }
.chart { display: block; width: 100%; height: auto; }
.chart text { font-size: 13px; fill: var(--soft); }
.chart .grid { stroke: var(--line); } .chart .axis { stroke: var(--soft); }
.chart .curve { fill: none; stroke: var(--p1); stroke-width: 2.2; stroke-linejoin: round; }
.chart .dot { fill: var(--p1); stroke: var(--card); stroke-width: 1.5; } .chart .bar { fill: var(--p1); }
.chart .threshold { stroke: var(--p5); stroke-width: 1.6; stroke-dasharray: 6 4; }
.chart .p0, .p0 { fill: var(--p0); background: var(--p0); } .chart .p1, .p1 { fill: var(--p1); background: var(--p1); }
.chart .p2, .p2 { fill: var(--p2); background: var(--p2); } .chart .p3, .p3 { fill: var(--p3); background: var(--p3); }
.chart .p6, .p6 { fill: var(--p6); background: var(--p6); } .chart .p7, .p7 { fill: var(--p7); background: var(--p7); }
.chart .p8, .p8 { fill: var(--p8); background: var(--p8); }
.chart .p4, .p4 { fill: var(--p4); background: var(--p4); } .chart .p5, .p5 { fill: var(--p5); background: var(--p5); }
.plot { margin-top: 0.9rem; } .plot svg { display: block; width: 100%; max-width: 48rem; height: auto;
  border-radius: 0.4rem; filter: var(--dim); }
.scroll { overflow-x: auto; margin-top: 1.3rem; }
details { margin-top: 0.9rem; } summary { cursor: pointer; color: var(--soft); }
.bars { margin: 0.5rem 0; } .bars dt { font-size: 0.9375rem; } .bars dd { display: flex; height: 1.1rem; margin: 0.1rem 0 0.5rem;
  print-color-adjust: exact; -webkit-print-color-adjust: exact; }
table { border-collapse: collapse; width: 100%; font-size: 0.9375rem; }
th, td { text-align: right; padding: 0.32rem 0 0.32rem 1.1rem; white-space: nowrap; border-bottom: 1px solid var(--line); }
th { color: var(--soft); font-weight: 500; font-size: 0.8125rem; vertical-align: bottom; white-space: normal; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
.facts { display: flex; flex-wrap: wrap; gap: 0.2rem 1.6rem; margin: 0.35rem 0 0.9rem; font-size: 0.9375rem; }
.facts div { display: flex; gap: 0.45rem; } .facts dt { color: var(--soft); } .facts dd { margin: 0; }
.pictures { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); grid-auto-flow: dense; gap: 1rem; }
.pictures .wide { grid-column: 1 / -1; }
.pictures img { display: block; width: 100%; height: auto; border-radius: 0.4rem; filter: var(--dim); }
.single { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 1rem; }
.single .pictures { grid-template-columns: minmax(0, 1fr); } .single .facts { flex-direction: column; }
.pairs { display: grid; grid-template-columns: max-content minmax(0, 1fr); gap: 0.25rem 1.4rem; margin: 0.6rem 0 0; }
.pairs dt { color: var(--soft); } .pairs dd { margin: 0; overflow-wrap: anywhere; }
footer { padding-top: 0.5rem; padding-bottom: 2.5rem; font-size: 0.875rem; }
dialog { border: 0; padding: 0; background: #101216; max-width: 100vw; max-height: 100vh; width: 100vw; height: 100vh; }
dialog img { width: 100%; height: 100%; object-fit: contain; display: block; cursor: zoom-out; }
@media (max-width: 40rem) {
  main, header, nav ul, footer { padding-left: 0.9rem; padding-right: 0.9rem; }
  section { padding: 0.9rem 0.9rem 1rem; margin: 0.9rem 0; }
  .tiles { grid-template-columns: repeat(2, minmax(0, 1fr)); } .tiles .big { font-size: 1.25rem; }
  .pictures, .single { grid-template-columns: minmax(0, 1fr); } .single { gap: 0; }
  .chart text { font-size: 15px; }
  .pairs { grid-template-columns: minmax(0, 1fr); gap: 0; } .pairs dd { margin-bottom: 0.5rem; } }
@media print { :root { --page: #ffffff; --card: #ffffff; --ink: #000000; --soft: #444444; --line: #bbbbbb;
    --accent: #000000; --dim: none; color-scheme: light; }
  nav, .hint, dialog { display: none; } body { font-size: 10pt; } section { border: 0; padding: 0; }
  .charts { grid-template-columns: repeat(2, minmax(0, 1fr)); } .scroll { overflow: visible; }
  table { font-size: 9pt; } th { white-space: normal; } th, td { padding-left: 0.7rem; }
  h2 { break-after: avoid; } figure, tr, .tiles div { break-inside: avoid; } .view { break-inside: avoid; } }
)css";
}

std::string_view run_report_script() {
  return R"js(
(function () {
  'use strict';
  var steps = Array.from(document.querySelectorAll('section[id]'));
  var chips = Array.from(document.querySelectorAll('nav a'));
  var dialog = document.createElement('dialog');
  var large = document.createElement('img');
  var shown = null;
  dialog.appendChild(large);
  document.body.appendChild(dialog);
  document.querySelectorAll('.hint').forEach(function (hint) { hint.hidden = false; });

  function current() {
    var line = 0.35 * innerHeight, index = 0;
    steps.forEach(function (step, i) { if (line > step.getBoundingClientRect().top) index = i; });
    return index;
  }
  function mark() {
    var id = '#' + steps[current()].id;
    chips.forEach(function (chip) {
      if (chip.getAttribute('href') === id) chip.setAttribute('aria-current', 'true');
      else chip.removeAttribute('aria-current');
    });
  }
  function show(image) {
    shown = image;
    large.src = image.src;
    large.alt = image.alt;
    if (!dialog.open) dialog.showModal();
  }
  function pictures(step) { return Array.from(step.querySelectorAll('.pictures img')); }
  function turn(by) {
    var step = shown.closest('section'), place = pictures(step).indexOf(shown);
    var from = steps.indexOf(step), kind = shown.dataset.kind;
    for (var i = from + by; steps[i]; i += by) {
      var there = pictures(steps[i]);
      var same = there.filter(function (image, at) { return kind ? image.dataset.kind === kind : at === place; })[0];
      if (same) { show(same); same.closest('section').scrollIntoView(); return; }
    }
  }
  document.querySelectorAll('.pictures img').forEach(function (image) {
    image.tabIndex = 0;
    image.style.cursor = 'zoom-in';
    image.addEventListener('click', function () { show(image); });
    image.addEventListener('keydown', function (event) { if (event.key === 'Enter') show(image); });
  });
  dialog.addEventListener('click', function () { dialog.close(); });
  addEventListener('keydown', function (event) {
    if (event.altKey || event.ctrlKey || event.metaKey || event.shiftKey) return;
    var by = event.key === 'ArrowRight' ? 1 : event.key === 'ArrowLeft' ? -1 : 0;
    if (by === 0) return;
    event.preventDefault();
    if (dialog.open) { turn(by); return; }
    var next = steps[current() + by];
    if (next) next.scrollIntoView();
  });
  addEventListener('scroll', mark, { passive: true });
  mark();
})();
)js";
}

}  // namespace saccade
