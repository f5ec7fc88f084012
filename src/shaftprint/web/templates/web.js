"use strict";
// Shows how far a job is as the server tells it, and loads the page again when the job has come to its end.
(() => {
  const place = document.getElementById("progress");
  if (!place || !place.dataset.events) return;
  const show = (name, text) => {
    const field = place.querySelector(`[data-field="${name}"]`);
    if (field) field.textContent = text;
  };
  const told = new EventSource(place.dataset.events);
  told.addEventListener("job", (event) => {
    const job = JSON.parse(event.data);
    if (job.state === "done" || job.state === "refused") {
      told.close();
      location.reload();
      return;
    }
    show("progress", job.progress || (job.state === "running" ? "A worker has begun it." : "A worker begins it as soon as one is free."));
    show("tries", String(job.tries));
    const heading = place.querySelector("h2");
    if (heading) heading.textContent = `Job ${job.id} ${job.word}`;
    place.dataset.state = job.state;
  });
  // The browser itself asks again when the server was away.
  told.addEventListener("error", () => show("progress", "The server does not answer; this page asks again until it does."));
})();
