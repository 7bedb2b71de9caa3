// Errors: the command's sentences as `Error`s, with their parts as properties.

/** An error: its message is one sentence, as the command `sprung` prints it. */
export class SprungError extends Error {
    constructor(message, parts) {
        super(message);
        this.sentence = message;
        Object.assign(this, parts);
    }
}
SprungError.prototype.name = "SprungError";

/** The simulation blew up; its last good state is the current one. */
export class BlowUpError extends SprungError {}
BlowUpError.prototype.name = "BlowUpError";

/** The error with these parts, as the engine has them. */
export function errorOf(message, { blowUp, ...parts }) {
    return blowUp === undefined ? new SprungError(message, parts) : new BlowUpError(message, { ...parts, ...blowUp });
}

/** An error of our own: what is wrong with a field, and what would mend it. */
export function mistake(code, field, sentence, fix) {
    const message = `${field === undefined ? "" : `${field}: `}${sentence}${fix === undefined ? "" : `; ${fix}`}`;
    const parts = Object.entries({ code, sentence, field, fix }).filter(([, part]) => part !== undefined);
    return new SprungError(message, Object.fromEntries(parts));
}

/** What crosses to another thread of an error. */
export function packedError(error) {
    const known = error instanceof SprungError ? { ...error } : { code: "Unsupported" };
    return { message: String(error?.message ?? error), blewUp: error instanceof BlowUpError, parts: known };
}

/** The error that crossed. */
export function unpackedError({ message, blewUp, parts }) {
    return blewUp ? new BlowUpError(message, parts) : new SprungError(message, parts);
}
