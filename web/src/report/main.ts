// SPDX-License-Identifier: Apache-2.0
// The page of reports: shows the record in the file, or follows the program that serves it.
import { Connection, ownClient } from "../connection";
import { fetchFile, withToken } from "../token";
import { embeddedDocument, type ReportDocument } from "./document";
import { ReportPage } from "./page";
import "./style";

async function fetchDocument(): Promise<ReportDocument> {
  const answer = await fetchFile("data/report");
  if (!answer.ok) throw new Error((await answer.text()).trim());
  return (await answer.json()) as ReportDocument;
}

async function follow(page: ReportPage): Promise<void> {
  page.say("Report", "Waiting for the program …");
  const connection = new Connection(await ownClient());
  const refresh = async () => {
    try {
      page.show(await fetchDocument());
    } catch (error) {
      page.say("There is no report", (error as Error).message);
    }
  };
  connection.on("document", () => void refresh());
  connection.watch((state) => {
    if (state === "closed") page.say("The program does not let this page in", "Open the address that it printed when it was started.");
    if (state === "connected") void refresh();
  });
  await connection.start();
}

const app = document.querySelector("#app")!;
const embedded = embeddedDocument();
if (embedded) new ReportPage(app).show(embedded);
else void follow(new ReportPage(app, withToken("./")));
