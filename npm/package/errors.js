// Errors: the command's sentences as `Error`s, with their parts as properties.

/** An error: its message is one sentence, as the command `sprung` prints it. */
export class SprungError extends Error {
    constructor(message, parts = {}) {
        super(message);
        this.name = "SprungError";
        const { code, sentence = message, file, line, column, field, fix } = parts;
        Object.assign(this, { code, sentence, file, line, column, field, fix });
    }
}

/** The simulation blew up; its last good state is the current one. */
export class BlowUpError extends SprungError {
    constructor(message, parts) {
        super(message, parts);
        this.name = "BlowUpError";
        Object.assign(this, parts.blowUp);
    }
}

/** The error with these parts. */
export function errorOf(message, parts) {
    return parts.blowUp ? new BlowUpError(message, parts) : new SprungError(message, parts);
}

/** An error of our own: what is wrong with a field, and what would mend it. */
export function mistake(code, field, sentence, fix) {
    const message = `${field === undefined ? "" : `${field}: `}${sentence}${fix === undefined ? "" : `; ${fix}`}`;
    return new SprungError(message, { code, sentence, field, fix });
}

/** What crosses to another thread of an error, and back. */
export function packedError(error) {
    const { message, stack } = error;
    if (!(error instanceof SprungError)) return { message: String(message ?? error), stack };
    const parts = { ...error };
    delete parts.name;
    if (error instanceof BlowUpError) parts.blowUp = parts;
    return { message, stack, parts: structuredClone(parts) };
}

export function unpackedError({ message, parts }) {
    return parts ? errorOf(message, parts) : new SprungError(message, { code: "Unsupported" });
}
