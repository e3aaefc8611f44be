// SPDX-License-Identifier: Apache-2.0
import { App } from "./app";
import { themeOfPage } from "./page/theme";
import { el } from "./dom/dom";

const theme = themeOfPage();
const token = location.hash.slice(1) || sessionStorage.getItem("kontur-token") || "";
if (token) {
  sessionStorage.setItem("kontur-token", token); // a reload finds it, other tabs do not
  new App(token, theme).start();
} else {
  document.body.append(
    el("p", { class: "no-token" }, "This address lacks its key. Open the whole address that `kontur open` printed, including what follows the #."),
  );
}
