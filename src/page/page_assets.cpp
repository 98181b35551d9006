#include "page/page_assets.h"

namespace vdbeam {

const char* const page_style = R"css(
:root {
  color-scheme: light dark;
  --back: #ffffff; --panel: #f4f5f7; --text: #1a1c20; --quiet: #565b66; --edge: #d5d8de;
  --data: #0062a8; --interval: #7fb2dc; --lost: #b3261e; --good: #1b6e3c; --link: #0062a8;
}
@media (prefers-color-scheme: dark) {
  :root {
    --back: #16181c; --panel: #202329; --text: #e8eaee; --quiet: #a6adba; --edge: #3a3f49;
    --data: #6cb8f0; --interval: #3f6f96; --lost: #ff8a80; --good: #7fd6a0; --link: #6cb8f0;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0 auto; padding: 1rem; max-width: 78rem; background: var(--back); color: var(--text);
  font: 1rem/1.45 system-ui, "Segoe UI", "Liberation Sans", sans-serif;
}
h1 { font-size: 1.5rem; margin: 0 0 .25rem; overflow-wrap: anywhere; }
h2 { font-size: 1.15rem; margin: 2rem 0 .5rem; }
p { margin: .25rem 0 .75rem; max-width: 46rem; }
.quiet, figcaption, dt { color: var(--quiet); }
code { font-family: ui-monospace, "Liberation Mono", monospace; font-size: .9em; overflow-wrap: anywhere; }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(9.5rem, 1fr)); gap: .75rem; margin: 1rem 0; }
.tile { background: var(--panel); border-radius: .5rem; padding: .6rem .8rem; }
.tile b { display: block; font-size: 1.35rem; font-weight: 600; }
.tile.bad b { color: var(--lost); }
.tile span { color: var(--quiet); font-size: .875rem; }
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(22rem, 100%), 1fr)); gap: 1rem; }
.charts figure { margin: 0; max-width: 37rem; }
.charts h3 { font-size: 1rem; margin: 0; }
svg { display: block; width: 100%; height: auto; font-size: 12px; }
svg text { fill: var(--quiet); }
.grid { stroke: var(--edge); stroke-width: 1; }
.axis { stroke: var(--quiet); stroke-width: 1; }
.line { fill: none; stroke: var(--data); stroke-width: 1.5; stroke-linejoin: round; }
.dot { fill: var(--data); }
.interval { stroke: var(--interval); stroke-width: 2.5; }
.lost { fill: none; stroke: var(--lost); stroke-width: 2; }
.hit { fill: transparent; }
g:hover > .hit { fill: var(--edge); fill-opacity: .4; }
.player { max-width: 32rem; }
.player img { display: block; width: 100%; background: #000; border-radius: .5rem; object-fit: contain; }
.controls { display: flex; flex-wrap: wrap; align-items: center; gap: .5rem .75rem; margin: .6rem 0; }
.controls input { flex: 1 1 10rem; min-width: 8rem; accent-color: var(--data); }
button, select {
  font: inherit; color: var(--text); background: var(--panel); border: 1px solid var(--edge);
  border-radius: .4rem; padding: .3rem .8rem; min-height: 2.25rem;
}
button { min-width: 5rem; }
:focus-visible { outline: 2px solid var(--link); outline-offset: 2px; }
#place { min-width: 6rem; font-variant-numeric: tabular-nums; }
.table { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; }
th, td { text-align: left; vertical-align: top; padding: .35rem .75rem .35rem 0; border-bottom: 1px solid var(--edge); }
td.number { font-variant-numeric: tabular-nums; white-space: nowrap; }
td.line-text { overflow-wrap: anywhere; min-width: 12rem; }
.strip { display: grid; grid-template-columns: repeat(auto-fill, minmax(9rem, 1fr)); gap: .75rem; }
.strip figure { margin: 0; }
.strip img, .empty { display: block; width: 100%; aspect-ratio: var(--shape, 16 / 9); object-fit: contain; background: #000; border-radius: .3rem; }
.strip img { cursor: pointer; }
.empty { background: var(--panel); border: 1px dashed var(--edge); }
figcaption { font-size: .875rem; }
.failed, .interrupted { color: var(--lost); }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .3rem 1rem; margin: 0; }
dd { margin: 0; overflow-wrap: anywhere; }
@media (max-width: 34rem) { dl { grid-template-columns: 1fr; } dd { margin-bottom: .4rem; } }
)css";

const char* const page_script = R"js(
(() => {
  const strip = [...document.querySelectorAll(".strip img")];
  const film = document.getElementById("film");
  if (!film || strip.length === 0)
    return;
  const place = document.getElementById("place"), slider = document.getElementById("slider"),
        play = document.getElementById("play"), rate = document.getElementById("rate");
  let at = 0, timer = null, loaded = null;

  function show(index) {
    at = (index + strip.length) % strip.length;
    film.src = strip[at].src;
    film.alt = strip[at].alt;
    slider.value = at;
    place.textContent = strip[at].alt;
  }
  function stop() {
    clearInterval(timer);
    timer = null;
    play.textContent = "Play";
  }
  function start() {
    // Images of the grid are loaded when they are scrolled to; the film needs all of them.
    loaded = loaded || strip.map(image => Object.assign(new Image(), {src: image.src}));
    clearInterval(timer);
    timer = setInterval(() => show(at + 1), 1000 / Number(rate.value));
    play.textContent = "Pause";
  }
  play.addEventListener("click", () => timer === null ? start() : stop());
  rate.addEventListener("change", () => timer !== null && start());
  slider.addEventListener("input", () => { stop(); show(Number(slider.value)); });
  strip.forEach((image, index) => image.addEventListener("click", () => {
    stop();
    show(index);
    film.scrollIntoView({block: "nearest"});
  }));
  show(0);
})();
)js";

} // namespace vdbeam
