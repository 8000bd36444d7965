/* The search of the site, for pages that are read from a folder as well: the index is a script, loaded with the first letter that is
 * typed. The box and the list of results are those of MkDocs' theme. */
(function () {
    var index = null, documents = {}, waiting = false;

    function load(file, then) {
        var script = document.createElement("script");
        script.src = base_url.replace(/\/?$/, "/") + "search/" + file;
        script.onload = then;
        document.head.appendChild(script);
    }

    function build() {
        index = lunr(function () {
            this.field("title", {boost: 10});
            this.field("text");
            this.ref("location");
            plm_search_index.docs.forEach(function (entry) {
                this.add(entry);
                documents[entry.location] = entry;
            }, this);
        });
    }

    function escaped(text) {
        var holder = document.createElement("div");
        holder.textContent = text;
        return holder.innerHTML;
    }

    /* The words as they are, and as the beginnings of longer ones. */
    function found(words) {
        return index.query(function (query) {
            lunr.tokenizer(words).forEach(function (word) {
                query.term(word, {boost: 10});
                query.term(word, {wildcard: lunr.Query.wildcard.TRAILING});
            });
        });
    }

    function show(words) {
        var list = document.getElementById("mkdocs-search-results");
        var results = words.length > 2 ? found(words).slice(0, 50) : [];
        list.innerHTML = results.map(function (result) {
            var entry = documents[result.ref];
            return "<article><h3><a href=\"" + base_url.replace(/\/?$/, "/") + entry.location + "\">" + escaped(entry.title) + "</a></h3><p>" +
                   escaped(entry.text.substring(0, 200)) + "</p></article>";
        }).join("") || "<p>No results found</p>";
    }

    function search() {
        var box = document.getElementById("mkdocs-search-query");
        if (index) {
            show(box.value.toLowerCase());
        } else if (!waiting) {
            waiting = true;
            load("lunr.js", function () { load("index.js", function () { build(); search(); }); });
        }
    }

    var box = document.getElementById("mkdocs-search-query");
    if (box) {
        box.addEventListener("keyup", search);
        var asked = /[?&]q=([^&]*)/.exec(window.location.search);
        if (asked) {
            box.value = decodeURIComponent(asked[1].replace(/\+/g, " "));
            search();
        }
    }
})();
