// SPDX-License-Identifier: Apache-2.0
// The token of the program. It is kept in this tab's storage, which knows the port, and is given in headers: browsers
// would send a cookie to the servers of every port of this machine.
const kKey = "saccade.token";
const kHeader = "Saccade-Token";

let taken: string | undefined;

/** Returns the token, which leaves the address; or this tab's own, where the page is loaded again; "" without one. */
export function token(): string {
  return (taken ??= takeToken());
}

function takeToken(): string {
  const address = new URL(location.href);
  const given = address.searchParams.get("token");
  if (given !== null) {
    address.searchParams.delete("token");
    history.replaceState(null, "", address);
  }
  try {
    if (given) sessionStorage.setItem(kKey, given);
    return given ?? sessionStorage.getItem(kKey) ?? "";
  } catch {
    return given ?? ""; // until the page is loaded again
  }
}

/** The address with the token, for a page in a tab of its own. */
export const withToken = (path: string): string => `${path}?token=${encodeURIComponent(token())}`;

/** Fetches a file of the program. */
export const fetchFile = (path: string, options: RequestInit = {}): Promise<Response> =>
  fetch(new URL(path, document.baseURI), { ...options, headers: { [kHeader]: token() } });

/** Subprotocols of the WebSocket, the only header that a page can give it. */
export const subprotocols = (): string[] => ["saccade.v1", `saccade.token.${token()}`];

/** Shows a picture of the program in `img` once it comes near the visible part. Elements fetch without headers. */
export function showPicture(img: HTMLImageElement, path: string): void {
  const near = new IntersectionObserver(
    (entries) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      near.disconnect();
      void fetchPicture(img, path);
    },
    { rootMargin: "600px" },
  );
  near.observe(img);
}

async function fetchPicture(img: HTMLImageElement, path: string): Promise<void> {
  try {
    const answer = await fetchFile(path);
    if (!answer.ok) throw new Error(answer.statusText);
    const address = URL.createObjectURL(await answer.blob());
    const release = () => URL.revokeObjectURL(address);
    img.addEventListener("load", release, { once: true });
    img.addEventListener("error", release, { once: true });
    img.src = address;
  } catch {
    img.dispatchEvent(new Event("error"));
  }
}
