// SPDX-License-Identifier: MIT
// Switches a page with #theme between light and dark. Without the switch the page follows the reader's system.
'use strict';

(() => {
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
})();
