// The report's animation, and its switch between light and dark; all else is there without it.
'use strict';

for (const box of document.querySelectorAll('.replay'))
  gatewalkReplay(box, JSON.parse(document.getElementById('film').textContent));

// A link to a claim opens it.
function open_target() {
  const claim = location.hash.length > 1 && document.getElementById(location.hash.slice(1));
  if (claim instanceof HTMLDetailsElement) {
    document.getElementById('show-all').checked = true;
    claim.open = true;
    claim.scrollIntoView();
  }
}
addEventListener('hashchange', open_target);
open_target();

const system = matchMedia('(prefers-color-scheme: dark)');
const button = document.getElementById('theme');
const is_dark = () => document.documentElement.dataset.theme ? document.documentElement.dataset.theme === 'dark' : system.matches;
function name_button() {
  button.textContent = is_dark() ? 'Light page' : 'Dark page';
}
button.hidden = false;
button.addEventListener('click', () => {
  document.documentElement.dataset.theme = is_dark() ? 'light' : 'dark';
  name_button();
});
system.addEventListener('change', name_button);
name_button();
