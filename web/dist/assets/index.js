document.querySelector("#app").textContent="Saccade";
