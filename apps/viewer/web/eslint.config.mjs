// SPDX-License-Identifier: Apache-2.0
// Rules that catch what the compiler lets through and a user then meets: an event handler that cancels the event by what it
// returns, and a promise whose failure nobody hears of. How the code looks is not their business.
import tseslint from "typescript-eslint";

const HANDLER = "Attach handlers by addEventListener, as `on` of el() does: what a handler property returns can cancel the event.";
const NAME = "/^on(?!(ce|e|ly|line)$)[a-z]+$/";

const handlerProperties = [
  { selector: `AssignmentExpression > MemberExpression.left > Identifier.property[name=${NAME}]`, message: HANDLER },
  { selector: `AssignmentExpression > MemberExpression.left > Literal.property[value=${NAME}]`, message: HANDLER },
  { selector: `Property > Identifier.key[name=${NAME}]`, message: HANDLER },
];

export default tseslint.config(
  { ignores: ["dist", "node_modules"] },
  {
    files: ["src/**/*.ts", "tests/**/*.ts"],
    plugins: { "@typescript-eslint": tseslint.plugin },
    languageOptions: { parser: tseslint.parser, parserOptions: { projectService: true, tsconfigRootDir: import.meta.dirname } },
    rules: {
      "no-restricted-syntax": ["error", ...handlerProperties],
      "max-params": ["error", 5], // as tools/check_declarations holds for C++
      "@typescript-eslint/strict-void-return": "error",
      "@typescript-eslint/no-misused-promises": "error",
      "@typescript-eslint/no-floating-promises": [
        "error",
        { allowForKnownSafeCalls: [{ from: "package", package: "node:test", name: ["test", "describe", "before", "after"] }] },
      ],
    },
  },
  {
    // Promises that wait for a test's state resolve with whatever is at hand.
    files: ["tests/**/*.ts"],
    rules: { "@typescript-eslint/strict-void-return": "off" },
  },
);
