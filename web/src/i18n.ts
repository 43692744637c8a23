// Texts of the page in English and Brazilian Portuguese. Messages of the program are in English.

const en = {
  'app.title': 'Faba live lab',
  'tab.bench': 'Bench', 'bench.title': 'Camera of the bench', 'bench.help': 'The coils are off on this page. Start a run on the bench with faba rig run.',
  'bench.scene': 'Scene with a bench', 'bench.open': 'Open the camera', 'bench.close': 'Close the camera', 'bench.picture': 'Camera picture', 'bench.waiting': 'Waiting for the first frame.',
  'bench.frames': '{n} frames, {dropped} dropped, {corrupt} corrupt', 'bench.grey': 'mean grey {mean}', 'bench.white': '{percent} % saturated', 'bench.camera': 'Camera', 'bench.nothing': 'This camera has no controls.',
  'bench.exposure': 'Exposure', 'bench.gain': 'Gain', 'bench.white_balance': 'White balance', 'bench.automatic': 'automatic', 'bench.scale': 'Scale',
  'bench.scale.help': 'Put a ruler under the microscope and measure it once for each objective.', 'bench.objective': 'Objective', 'bench.tick': 'Tick spacing', 'bench.measure': 'Measure the ruler',
  'bench.interval': '(95 %: {low} to {high})', 'bench.kept': '{n} marks found; saved as {file}.', 'bench.poor': '{n} marks found, too few or too uneven; not saved.', 'bench.marks': 'Detected marks',
  'tab.lab': 'Lab', 'tab.gallery': 'Gallery', 'tab.runs': 'Runs', 'tab.analyse': 'Analyse',
  'lost': 'Connection lost. Reconnecting …', 'refused': 'The access token of this page is not valid any more. Open the URL printed by faba lab.', 'again': 'Retry now',
  'steer.other': 'Another page controls the swarm.', 'steer.take': 'Take control', 'pages': '{n} pages connected',
  'hint.1': 'Drag on the picture: the swarm swims in the direction of the drag.',
  'hint.2': 'Click to set a setpoint for the controller. Hold Shift and click to set the points of a route.',
  'hint.3': 'All other settings are in the panel and can be changed during the run. Space pauses.',
  'hint.close': 'Close',
  'run.pause': 'Pause', 'run.go': 'Resume', 'run.step': 'One frame', 'run.restart': 'Restart', 'run.speed': 'Speed', 'run.real': 'actual {x}×',
  'run.reverse': 'Reverse field', 'run.save': 'Record', 'run.name': 'Recording name', 'run.none': 'No simulation is running. Choose a scene in the gallery.', 'run.stopped': 'The run has ended',
  'steer': 'Steer', 'steer.hand': 'Manual field', 'steer.goal': 'Setpoint', 'steer.route': 'Route', 'steer.strength': 'Field strength', 'steer.stop': 'Zero field',
  'steer.hand.help': 'Drag on the picture, or use the arrow keys or a gamepad.', 'steer.goal.help': 'Click on the picture.',
  'steer.route.help': 'Hold Shift and click the points of the route in order, then press Follow route. Drag a point to move it.', 'steer.route.send': 'Follow route', 'steer.route.clear': 'Clear',
  'scenario': 'Scenario', 'scenario.restart': 'Restart with these settings', 'scenario.live': 'Apply', 'scenario.save': 'Export', 'scenario.load': 'Import', 'scenario.copy': 'Copy command', 'scenario.copied': 'Copied',
  'scenario.undo': 'Undo', 'scenario.advanced': 'All settings', 'seed.new': 'Another seed', 'seed.now': 'seed {n}', 'scenario.needs_restart': 'takes effect after a restart', 'scenario.changed_now': 'changed',
  'read.swarm': 'Swarm', 'read.spread': 'spread', 'read.goal': 'distance to setpoint', 'read.responding': 'responsive', 'read.currents': 'coils', 'read.coil': 'Coil',
  'run.as_seen': 'as the camera sees it (for analysis)', 'gallery.cancel': 'Cancel', 'scenario.from_first': 'The exported file uses these values from the first frame. A recording stores each change with its time.', 'scenario.needs_file': 'The command reads {file}: press Export first and save the file under this name.', 'form.range': 'from {low} to {high}', 'analyse.current': 'Currents, A',
  'layers': 'Layers', 'layer.trails': 'Trails', 'layer.density': 'Density', 'layer.field': 'Field', 'layer.edge': 'Edge', 'layer.swarm': 'Swarm', 'layer.route': 'Setpoints', 'layer.camera': 'Camera picture', 'view.fit': 'Fit to view',
  'plots': 'Plots', 'plot.distance': 'Distance to the setpoint', 'plot.dispersion': 'Dispersion', 'plot.field': 'Field', 'plot.responding': 'Responsive cells', 'plot.speed': 'Speed of the swarm', 'plot.activity': 'Activity: mean speed of the cells', 'plot.earlier': 'recorded',
  'gallery.title': 'Scenes', 'gallery.start': 'Start', 'gallery.drop': 'Drop a picture or video of a real drop here, or choose a file', 'gallery.looking': 'Detecting the edge …', 'gallery.edge': 'Edge of the drop',
  'gallery.edge.help': 'Drag the circle to move it, or its rim to change the radius; then press Start.', 'gallery.cells': '{n} cells', 'gallery.no_drop': 'No arena with a circular edge is available.',
  'runs.title': 'Recorded runs', 'runs.none': 'No recorded runs. Press Record during a run.', 'runs.report': 'Report', 'runs.replay': 'Replay', 'runs.video': 'Video', 'runs.again': 'Use this scenario', 'runs.pin': 'Compare', 'runs.broken': 'incomplete',
  'jobs': 'Jobs', 'jobs.none': 'No jobs.', 'jobs.cancel': 'Cancel', 'job.waiting': 'queued', 'job.running': 'running', 'job.done': 'done', 'job.failed': 'failed', 'job.cancelled': 'cancelled', 'job.left': '{t} left', 'job.open': 'Open', 'job.close': 'Close', 'job.tab': 'Open in a new tab',
  'analyse.title': 'Analyse', 'analyse.activity': 'Activity of a video', 'analyse.compare': 'Compare two videos', 'analyse.identify': 'Identify a model, compare controllers', 'analyse.field': 'Field map', 'analyse.start': 'Start', 'analyse.direction': 'Swimming direction, degrees (0 right, 90 down)', 'analyse.video': 'Video or run', 'analyse.reference': 'Reference', 'analyse.study': 'Study', 'analyse.rig': 'Coil system',
  'form.number': 'must be a number', 'form.unit': 'needs a unit such as {unit}', 'form.integer': 'must be an integer', 'form.least': 'must be at least {limit}', 'form.most': 'must be at most {limit}', 'form.source': 'source: {source}', 'form.reset': 'Reset to default', 'form.add': 'Add', 'form.remove': 'Remove', 'form.none': 'none', 'form.pair': 'needs two numbers, x and y, on each line', 'form.type': 'type', 'form.preset': 'preset', 'form.no_preset': 'custom',
  'view.label': 'Simulated microscope view of the swarm',
  'language': 'Language', 'theme': 'Light or dark theme',
} as const;

export type Word = keyof typeof en;

const pt: Record<Word, string> = {
  'app.title': 'Faba, laboratório ao vivo',
  'tab.bench': 'Bancada', 'bench.title': 'Câmera da bancada', 'bench.help': 'As bobinas estão desligadas nesta página. Inicie uma execução na bancada com faba rig run.',
  'bench.scene': 'Cena com bancada', 'bench.open': 'Abrir a câmera', 'bench.close': 'Fechar a câmera', 'bench.picture': 'Imagem da câmera', 'bench.waiting': 'Aguardando o primeiro quadro.',
  'bench.frames': '{n} quadros, {dropped} perdidos, {corrupt} corrompidos', 'bench.grey': 'cinza médio {mean}', 'bench.white': '{percent} % saturado', 'bench.camera': 'Câmera', 'bench.nothing': 'Esta câmera não tem controles.',
  'bench.exposure': 'Exposição', 'bench.gain': 'Ganho', 'bench.white_balance': 'Balanço de branco', 'bench.automatic': 'automático', 'bench.scale': 'Escala',
  'bench.scale.help': 'Coloque uma régua sob o microscópio e meça-a uma vez para cada objetiva.', 'bench.objective': 'Objetiva', 'bench.tick': 'Espaçamento das marcas', 'bench.measure': 'Medir a régua',
  'bench.interval': '(95 %: {low} a {high})', 'bench.kept': '{n} marcas encontradas; salvo em {file}.', 'bench.poor': '{n} marcas encontradas, poucas ou irregulares; não salvo.', 'bench.marks': 'Marcas detectadas',
  'tab.lab': 'Laboratório', 'tab.gallery': 'Galeria', 'tab.runs': 'Gravações', 'tab.analyse': 'Análise',
  'lost': 'Conexão perdida. Reconectando …', 'refused': 'O token de acesso desta página não é mais válido. Abra o endereço mostrado por faba lab.', 'again': 'Tentar agora',
  'steer.other': 'Outra página controla o enxame.', 'steer.take': 'Assumir o controle', 'pages': '{n} páginas conectadas',
  'hint.1': 'Arraste sobre a imagem: o enxame nada na direção do movimento do mouse.',
  'hint.2': 'Clique para definir o setpoint do controlador. Segure Shift e clique para definir os pontos de uma rota.',
  'hint.3': 'Todos os outros ajustes estão no painel e podem ser alterados durante a execução. Espaço pausa.',
  'hint.close': 'Fechar',
  'run.pause': 'Pausar', 'run.go': 'Continuar', 'run.step': 'Um quadro', 'run.restart': 'Reiniciar', 'run.speed': 'Velocidade', 'run.real': 'efetiva {x}×',
  'run.reverse': 'Inverter campo', 'run.save': 'Gravar', 'run.name': 'Nome da gravação', 'run.none': 'Nenhuma simulação em execução. Escolha uma cena na galeria.', 'run.stopped': 'A execução terminou',
  'steer': 'Controle', 'steer.hand': 'Campo manual', 'steer.goal': 'Setpoint', 'steer.route': 'Rota', 'steer.strength': 'Intensidade do campo', 'steer.stop': 'Campo nulo',
  'steer.hand.help': 'Arraste sobre a imagem, ou use as setas do teclado ou um gamepad.', 'steer.goal.help': 'Clique na imagem.',
  'steer.route.help': 'Segure Shift e clique nos pontos da rota em ordem, depois clique em Seguir rota. Arraste um ponto para movê-lo.', 'steer.route.send': 'Seguir rota', 'steer.route.clear': 'Limpar',
  'scenario': 'Cenário', 'scenario.restart': 'Reiniciar com estes ajustes', 'scenario.live': 'Aplicar', 'scenario.save': 'Exportar', 'scenario.load': 'Importar', 'scenario.copy': 'Copiar comando', 'scenario.copied': 'Copiado',
  'scenario.undo': 'Desfazer', 'scenario.advanced': 'Todos os ajustes', 'seed.new': 'Outra semente', 'seed.now': 'semente {n}', 'scenario.needs_restart': 'vale após reiniciar', 'scenario.changed_now': 'alterado',
  'read.swarm': 'Enxame', 'read.spread': 'dispersão', 'read.goal': 'distância ao setpoint', 'read.responding': 'responsivas', 'read.currents': 'bobinas', 'read.coil': 'Bobina',
  'run.as_seen': 'como a câmera vê (para análise)', 'gallery.cancel': 'Cancelar', 'scenario.from_first': 'O arquivo exportado usa estes valores desde o primeiro quadro. Uma gravação registra cada alteração com o seu tempo.', 'scenario.needs_file': 'O comando lê {file}: clique antes em Exportar e salve o arquivo com este nome.', 'form.range': 'de {low} a {high}', 'analyse.current': 'Correntes, A',
  'layers': 'Camadas', 'layer.trails': 'Rastros', 'layer.density': 'Densidade', 'layer.field': 'Campo', 'layer.edge': 'Borda', 'layer.swarm': 'Enxame', 'layer.route': 'Setpoints', 'layer.camera': 'Imagem da câmera', 'view.fit': 'Ajustar à vista',
  'plots': 'Gráficos', 'plot.distance': 'Distância ao setpoint', 'plot.dispersion': 'Dispersão', 'plot.field': 'Campo', 'plot.responding': 'Células responsivas', 'plot.speed': 'Velocidade do enxame', 'plot.activity': 'Atividade: velocidade média das células', 'plot.earlier': 'gravada',
  'gallery.title': 'Cenas', 'gallery.start': 'Iniciar', 'gallery.drop': 'Solte aqui uma imagem ou vídeo de uma gota real, ou escolha um arquivo', 'gallery.looking': 'Detectando a borda …', 'gallery.edge': 'Borda da gota',
  'gallery.edge.help': 'Arraste o círculo para movê-lo, ou a borda para mudar o raio; depois clique em Iniciar.', 'gallery.cells': '{n} células', 'gallery.no_drop': 'Não há arena com borda circular.',
  'runs.title': 'Gravações', 'runs.none': 'Nenhuma gravação. Clique em Gravar durante uma execução.', 'runs.report': 'Relatório', 'runs.replay': 'Reproduzir', 'runs.video': 'Vídeo', 'runs.again': 'Usar este cenário', 'runs.pin': 'Comparar', 'runs.broken': 'incompleta',
  'jobs': 'Tarefas', 'jobs.none': 'Nenhuma tarefa.', 'jobs.cancel': 'Cancelar', 'job.waiting': 'na fila', 'job.running': 'em execução', 'job.done': 'concluída', 'job.failed': 'falhou', 'job.cancelled': 'cancelada', 'job.left': 'faltam {t}', 'job.open': 'Abrir', 'job.close': 'Fechar', 'job.tab': 'Abrir em nova aba',
  'analyse.title': 'Análise', 'analyse.activity': 'Atividade de um vídeo', 'analyse.compare': 'Comparar dois vídeos', 'analyse.identify': 'Identificar um modelo, comparar controladores', 'analyse.field': 'Mapa do campo', 'analyse.start': 'Iniciar', 'analyse.direction': 'Direção do nado, graus (0 direita, 90 para baixo)', 'analyse.video': 'Vídeo ou gravação', 'analyse.reference': 'Referência', 'analyse.study': 'Estudo', 'analyse.rig': 'Sistema de bobinas',
  'form.number': 'deve ser um número', 'form.unit': 'precisa de uma unidade como {unit}', 'form.integer': 'deve ser um número inteiro', 'form.least': 'deve ser no mínimo {limit}', 'form.most': 'deve ser no máximo {limit}', 'form.source': 'fonte: {source}', 'form.reset': 'Restaurar o padrão', 'form.add': 'Adicionar', 'form.remove': 'Remover', 'form.none': 'nenhum', 'form.pair': 'precisa de dois números, x e y, em cada linha', 'form.type': 'tipo', 'form.preset': 'predefinição', 'form.no_preset': 'personalizado',
  'view.label': 'Vista simulada do enxame no microscópio',
  'language': 'Idioma', 'theme': 'Tema claro ou escuro',
};

export type Language = 'en' | 'pt';
export const kWords: Record<Language, Record<Word, string>> = { en, pt };

export function words(language: Language) {
  return (key: Word, values: Record<string, string | number> = {}) =>
    kWords[language][key].replace(/\{(\w+)\}/g, (all, name) => (name in values ? String(values[name]) : all));
}
export type Say = ReturnType<typeof words>;
