// Keeps the page's files, so that it works without a network after the first visit. Files of another build are another cache's.

/* global BUILD, FILES */
importScripts("build.js");

const cache = () => caches.open(BUILD);

addEventListener("install", (event) => {
  event.waitUntil(cache().then((kept) => kept.addAll(FILES)).then(() => skipWaiting()));
});

addEventListener("activate", (event) => {
  const old = async () => {
    const names = await caches.keys();
    await Promise.all(names.filter((name) => name.startsWith("sprung ") && name !== BUILD).map((name) => caches.delete(name)));
    await clients.claim();
  };
  event.waitUntil(old());
});

addEventListener("fetch", (event) => {
  const url = new URL(event.request.url);
  if (event.request.method !== "GET" || url.origin !== location.origin) return;
  const answer = async () => {
    const kept = await (await cache()).match(event.request, { ignoreSearch: true });
    return kept ?? fetch(event.request);
  };
  event.respondWith(answer());
});
