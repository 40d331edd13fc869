// Speaks to a language server over its standard input and output, as an editor does.

import {spawn} from "node:child_process";
import {readFileSync, readdirSync} from "node:fs";
import {join, resolve} from "node:path";
import {pathToFileURL} from "node:url";

const root = resolve(".");
const server = spawn(process.execPath, [process.argv[2], "--stdio"], {stdio: ["pipe", "pipe", "inherit"]});
const waiting = new Map();
const listeners = new Set();
let received = Buffer.alloc(0);
let lastId = 0;

function send(message) {
  const text = JSON.stringify({jsonrpc: "2.0", ...message});
  server.stdin.write(`Content-Length: ${Buffer.byteLength(text)}\r\n\r\n${text}`);
}

const request = (method, params) =>
  new Promise((done, fail) => {
    lastId += 1;
    waiting.set(lastId, {done, fail});
    send({id: lastId, method, params});
  });

server.stdout.on("data", chunk => {
  received = Buffer.concat([received, chunk]);
  for (;;) {
    const end = received.indexOf("\r\n\r\n");
    const length = end < 0 ? NaN : Number(/Content-Length: (\d+)/i.exec(received.subarray(0, end).toString())[1]);
    if (!(received.length >= end + 4 + length)) return;
    const message = JSON.parse(received.subarray(end + 4, end + 4 + length).toString());
    received = received.subarray(end + 4 + length);
    answer(message);
  }
});

const settings = {
  yaml: {validate: true, completion: true, hover: true, schemaStore: {enable: false}, schemas: {}},
};

function answer(message) {
  if (message.method && message.id !== undefined) {
    // The server asks for its settings; whatever else it asks, there is nothing to say.
    const items = message.params?.items ?? [];
    const result = message.method === "workspace/configuration" ? items.map(({section}) => settings[section] ?? null) : null;
    send({id: message.id, result});
  } else if (message.id !== undefined) {
    const {done, fail} = waiting.get(message.id);
    waiting.delete(message.id);
    message.error ? fail(new Error(message.error.message)) : done(message.result);
  } else {
    listeners.forEach(listener => listener(message));
  }
}

let opened = 0;

// Opens a text as a file beside the experiments, so that its schema line leads where it does in the study.
async function open(text) {
  opened += 1;
  const uri = pathToFileURL(join(root, `experiments/ch3/ch3-editor-${opened}.yaml`)).href;
  const diagnostics = new Promise((done, fail) => {
    const timer = setTimeout(() => fail(new Error(`no word about ${uri}`)), 60_000);
    const listener = ({method, params}) => {
      if (method === "textDocument/publishDiagnostics" && params.uri === uri) {
        clearTimeout(timer);
        listeners.delete(listener);
        done(params.diagnostics);
      }
    };
    listeners.add(listener);
  });
  send({method: "textDocument/didOpen", params: {textDocument: {uri, languageId: "yaml", version: 1, text}}});
  return {uri, diagnostics: await diagnostics};
}

const withSchema = (kind, text) => `# yaml-language-server: $schema=../../schema/${kind}.json\n${text}`;

const files = folder =>
  readdirSync(folder, {withFileTypes: true}).flatMap(entry =>
    entry.isDirectory() ? files(join(folder, entry.name)) : entry.name.endsWith(".yaml") ? [join(folder, entry.name)] : [],
  );

let failures = 0;
let checks = 0;

function expect(holds, what) {
  checks += 1;
  if (!holds) {
    failures += 1;
    console.error(`error: ${what}`);
  }
}

const told = diagnostics => diagnostics.map(one => `${one.range.start.line + 1}: ${one.message}`).join("; ");

// Every file of the study, as it is.
async function goodFiles() {
  for (const [kind, folder] of [["experiment", "experiments"], ["reference", "reference"]]) {
    for (const file of files(folder)) {
      const schema = file.endsWith("assumptions.yaml") ? "assumptions" : kind;
      const {diagnostics} = await open(withSchema(schema, readFileSync(file, "utf8")));
      expect(diagnostics.length === 0, `${file} is right, and yet: ${told(diagnostics)}`);
    }
  }
}

// The file that says what the study is.
async function study() {
  const {diagnostics} = await open(withSchema("study", readFileSync("study.yaml", "utf8")));
  expect(diagnostics.length === 0, `study.yaml is right, and yet: ${told(diagnostics)}`);
}

// A mistake stands on a line that says so; the server has to point at it, and at no line that is right.
async function badFiles() {
  for (const file of files("tests/editor/bad")) {
    const text = readFileSync(file, "utf8");
    const {diagnostics} = await open(text);
    const wrong = text.split("\n").flatMap((line, index) => (line.includes("# wrong") ? [index] : []));
    const lines = new Set(diagnostics.map(one => one.range.start.line));
    wrong.forEach(line => expect(lines.has(line), `${file}:${line + 1}: the mistake is not shown: ${told(diagnostics)}`));
    lines.forEach(line => expect(wrong.includes(line), `${file}:${line + 1} is right, and yet: ${told(diagnostics)}`));
  }
}

// Opens a text with a mark where the cursor stands, and gives what is offered there.
async function offered(text, kind) {
  const before = withSchema(kind, text).split("|")[0].split("\n");
  const {uri} = await open(withSchema(kind, text).replace("|", ""));
  const position = {line: before.length - 1, character: before.at(-1).length};
  const answer = await request("textDocument/completion", {textDocument: {uri}, position});
  return (answer.items ?? answer).map(item => item.label);
}

async function completions() {
  const offers = [
    ["ti|", ["title"]],
    ["title: x\n|", ["scene", "measure", "optimise"]],
    ["measure: vel|", ["velocity_ratio"]],
    ["scene:\n  structure:\n    |", ["single_mass", "cantilever_beam", "supported_plate"]],
    ["scene:\n  dampers:\n    - floor:\n        |", ["rigid", "resilient"]],
    ["sweep:\n  |", ["force_ratio", "gap_ratio", "union"]],
    ["sweep:\n  stop: [w|]", ["with", "without"]],
    ["run:\n  |", ["solver", "skip", "ensemble"]],
    ["figure:\n  x: {column: force_ratio, scale: l|}", ["log", "linear"]],
    ["scene:\n  gravity: {assumed: |}", ["gravity"]],
    ["entries:\n  - claim:\n      |", ["monotone", "levels_off"], "reference"],
    ["entries:\n  - from:\n      argmax:\n        |", ["of", "over", "where", "table"], "reference"],
    ["entries:\n  - claim:\n      monotone:\n        of: vel|", ["velocity_ratio"], "reference"],
  ];
  for (const [text, wanted, kind = "experiment"] of offers) {
    const labels = await offered(text, kind);
    wanted.forEach(word => expect(labels.includes(word), `${JSON.stringify(text)}: ${word} is not among ${labels}`));
  }
}

async function hover() {
  const {uri} = await open(withSchema("experiment", "scene:\n  dampers:\n    - mass_ratio: 0.05\n"));
  const answer = await request("textDocument/hover", {textDocument: {uri}, position: {line: 3, character: 8}});
  expect(JSON.stringify(answer).includes("mass of the damper"), `mass_ratio is explained: ${JSON.stringify(answer)}`);
}

await request("initialize", {
  processId: process.pid,
  rootUri: pathToFileURL(root).href,
  capabilities: {
    workspace: {configuration: true},
    textDocument: {publishDiagnostics: {}, completion: {completionItem: {snippetSupport: false}}, hover: {}},
  },
  workspaceFolders: null,
});
send({method: "initialized", params: {}});
send({method: "workspace/didChangeConfiguration", params: {settings}});
for (const part of [goodFiles, study, badFiles, completions, hover]) await part();
console.log(`tests/editor: ${checks - failures} of ${checks} checks passed`);
server.kill();
process.exit(failures > 0 ? 1 : 0);
