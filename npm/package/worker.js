// The thread of a simulation, in a browser.

import { serve } from "./serve.js";

serve((message, transfer) => self.postMessage(message, transfer), (listen) => (self.onmessage = ({ data }) => listen(data)));
