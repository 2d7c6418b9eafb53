// What scrolls can be reached by the keyboard.
document.addEventListener("DOMContentLoaded", () => {
  for (const place of document.querySelectorAll(".table-wrapper, article pre, .sidebar-scroll, .toc-scroll")) {
    place.tabIndex = 0;
  }
  // A heading that is a role has a level.
  for (const caption of document.querySelectorAll(".caption[role=heading]")) {
    caption.ariaLevel = "2";
  }
});
