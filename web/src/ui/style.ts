// SPDX-License-Identifier: Apache-2.0
// The style sheets that both modes of the page share, in their order.
import "./theme.css";
import "./controls.css";
import "./layout.css";
import "./sheets.css";
import "./narrow.css";
