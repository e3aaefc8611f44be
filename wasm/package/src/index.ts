// SPDX-License-Identifier: Apache-2.0
export * from "./client.js";
export * from "./kontur.js";
export * from "./types.js";
