// SPDX-License-Identifier: Apache-2.0
// The page: takes the token out of the address, asks the program what it is for, and becomes that.
import "./ui/theme.css";

document.querySelector<HTMLDivElement>("#app")!.textContent = "Saccade";
