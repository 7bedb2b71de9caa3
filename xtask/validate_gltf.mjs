// The Khronos glTF validator over files: no error, no warning, nothing else to say.
//
//   node validate_gltf.mjs FOLDER_OF_NODE_MODULES FILE...

import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const [modules, ...files] = process.argv.slice(2);
const validator = createRequire(`${modules}/`)('gltf-validator');
for (const file of files) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), { maxIssues: 20 });
  const { numErrors, numWarnings, numInfos, numHints, messages } = report.issues;
  const { drawCallCount, totalVertexCount, animationCount } = report.info;
  console.log(
    `${file}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos, ${numHints} hints; ` +
      `${drawCallCount} draw calls, ${totalVertexCount} vertices, ${animationCount} animations`,
  );
  if (numErrors + numWarnings + numInfos + numHints > 0) {
    for (const message of messages) console.log(`  ${message.pointer}: ${message.code}: ${message.message}`);
    process.exitCode = 1;
  }
}
