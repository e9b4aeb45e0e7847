// SPDX-License-Identifier: Apache-2.0
// The style sheets of reports, in their order.
import "../ui/theme.css";
import "../ui/controls.css";
import "../ui/sheets.css";
import "./report.css";
import "./table.css";
import "./pictures.css";
import "./print.css";
