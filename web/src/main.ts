// SPDX-License-Identifier: Apache-2.0
// The page: asks the program what it is for, and becomes that.
import { Connection, ownClient } from "./connection";
import { fill, h } from "./ui/dom";
import "./ui/style";

const app = document.querySelector<HTMLDivElement>("#app")!;

function say(title: string, text: string): void {
  fill(app, h("div", { class: "notice", role: "status" }, h("h1", {}, title), h("p", {}, text)));
}

async function main(): Promise<void> {
  const patience = window.setTimeout(() => say("Connecting …", "The program has not answered yet."), 800);
  const connection = new Connection(await ownClient());
  const stop = connection.watch((state) => {
    if (state !== "closed") return;
    clearTimeout(patience);
    say("The program does not let this page in", "Open the address that it printed when it was started.");
  });
  const hello = await connection.start();
  clearTimeout(patience);
  stop();
  document.title = hello.title ? `${hello.title} · Saccade` : "Saccade";
  if (hello.mode === "annotate") (await import("./annotate/annotate")).startAnnotate(connection, hello, app);
  else if (hello.mode === "show") (await import("./show/show")).startShow(connection, hello, app);
  else say("Nothing to show", `This page does not know the mode "${hello.mode}" of the program.`);
}

void main();
