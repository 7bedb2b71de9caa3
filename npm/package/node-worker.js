// The thread of a simulation, in Node.js.

import { parentPort } from "node:worker_threads";

import { serve } from "./serve.js";

serve((message, transfer) => parentPort.postMessage(message, transfer), (listen) => parentPort.on("message", listen));
