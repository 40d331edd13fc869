// Animations: a button stops and starts each.
(() => {
  for (const svg of document.querySelectorAll("figure svg")) {
    if (!svg.querySelector("[data-move]")) continue;
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = "Pause";
    button.addEventListener("click", () => {
      const still = svg.classList.toggle("still");
      button.textContent = still ? "Play" : "Pause";
    });
    svg.after(button);
  }
})();
