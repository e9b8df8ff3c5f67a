// SPDX-License-Identifier: MIT
// The report's animation, and links to claims. Everything else works without this script.
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
